#include "fppg/error.h"
#include "fppg/generate.h"
#include "fppg/read_particles.h"
#include "fuzz/targets.h"
#include "fuzz/working_folder.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace fppg::fuzz
{
namespace
{

/// Nodes of a domain and commands that are drawn; more would make the fuzzer slow.
constexpr double most_nodes = 30000;
constexpr std::size_t most_commands = 200;

[[noreturn]] void tell_fault(const char* what)
{
    std::fprintf(stderr, "wrong result without a word: %s\n", what);
    std::abort();
}

bool is_small(const CaseDef& def)
{
    const auto& n = def.grid.n;
    return 1.0 * n[0] * n[1] * n[2] <= most_nodes && def.ops.size() <= most_commands;
}

/// What no definition may lead to without an error.
void expect_sane(const CaseParticles& particles)
{
    if (particles.np !=
        particles.n_fixed + particles.n_moving + particles.n_floating + particles.n_fluid)
        tell_fault("the counts of the types do not add up");
    for (const float rhop : particles.rhop)
        if (!std::isfinite(rhop)) tell_fault("a density is no number");
    for (const auto& n : particles.bound_normals)
        if (!is_finite({n[0], n[1], n[2]})) tell_fault("a normal is no number");
}

/// What is written comes back.
void expect_readable(GeneratedCase& made)
{
    (void)made.save("Case", {});
    const ParticleCloud cloud = read_particles("Case", false, 1);
    if (cloud.positions.size() != made.particles().np)
        tell_fault("the file has another number of particles");
    for (const Vec3& place : cloud.positions)
        if (!is_finite(place)) tell_fault("a place is no number");
}

} // namespace

void generate_particles(std::string_view bytes)
{
    write_input("Case_Def.xml", bytes);
    // Half of all inputs also fit the walls that the definition leaves on the lattice.
    const FitChoice fit = bytes.size() % 2 == 0 ? FitChoice::AsCase : FitChoice::On;
    CaseOptions options;
    options.fit = fit;
    options.case_name = "Case";
    if (!is_small(read_case("Case_Def.xml", options))) return;
    GeneratedCase made = generate_case("Case_Def.xml", {.fit = fit, .threads = 1});
    expect_sane(made.particles());
    if (made.particles().np > 0) expect_readable(made);
}

} // namespace fppg::fuzz
