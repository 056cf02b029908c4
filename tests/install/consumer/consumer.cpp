#include <fppg/vec.h>
#include <fppg/version.h>
#include <iostream>

int main()
{
    fppg::Transform move;
    move.offset = {1, 0, 0};
    std::cout << "fppg " << fppg::version << '\n';
    return (move * move)({0, 0, 0}).x == 2 ? 0 : 1;
}
