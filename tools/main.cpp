#include "tools/commands/command_line.h"

int main(int argc, char** argv) { return flowskin::tools::run_program(argc, argv); }
