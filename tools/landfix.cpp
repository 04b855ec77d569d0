#include "tools/command.hpp"

int main(int argc, char** argv) { return landfix::tools::run(argc, argv); }
