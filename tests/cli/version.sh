# the build
talus --version | sed -E 's/\(.*\)/(...)/'
