// Most loops of a case last less than a millisecond, and other programs use the machine too. A team
// of OpenMP that waits actively between them then takes 2 to 4 times the processor time on a busy
// machine, and gains nothing on an idle one (tools/bench/NOTES.md has the figures). GCC's runtime
// reads its policy once, before main. It is a part of the program (see CMakeLists.txt), so that
// this runs before it.
#include "platform/start.h"

#include <cstdlib>

namespace
{

/// What the user chose for OpenMP stays.
[[gnu::constructor(101)]] void wait_passively()
{
    if (std::getenv("GOMP_SPINCOUNT") == nullptr)
        fppg::set_default_variable("OMP_WAIT_POLICY", "passive");
}

} // namespace
