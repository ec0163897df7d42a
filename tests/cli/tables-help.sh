talus-tables --help
talus tables --help | cmp - <(talus-tables --help)
