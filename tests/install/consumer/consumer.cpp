#include <fppg/case_def.h>
#include <fppg/version.h>
#include <iostream>

int main(int, char** argv)
{
    const fppg::CaseDef def = fppg::read_case(argv[1], {});
    std::cout << "fppg " << fppg::version << ", dp " << def.grid.dp << '\n';
}
