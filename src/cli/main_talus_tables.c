/* talus-tables: the aggregator alone; `talus tables` is the same. */
#include "base/crash.h"
#include "cli/commands.h"

int main(int argc, char **argv)
{
	crash_install();
	crash_exit(command_tables.main(argc, argv));
}
