talus plot --help
