#include "tools/mpm/app/program.hpp"

int main(int argc, char** argv) { return mpm::program(argc, argv, {}); }
