talus campaign --help
