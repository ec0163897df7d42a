/* talus-tables: the aggregator alone; `talus tables` is the same. */
#include "cli/commands.h"

int main(int argc, char **argv)
{
	return command_tables.main(argc, argv);
}
