#pragma once

#include "fppg/files.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace fppg
{

/// A folder of its own for a test, removed afterwards.
class TestFolder
{
public:
    TestFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "fppg-test-XXXXXX").string();
        if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~TestFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }
    /// Names of all files inside.
    std::vector<std::string> names() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            names.push_back(entry.path().filename().string());
        return names;
    }

private:
    std::filesystem::path path_;
};

inline std::string read_whole(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// What `write` puts into a file.
inline std::string written(const std::function<void(OutputFile&)>& write)
{
    const TestFolder folder;
    OutputFile file(folder / "file");
    write(file);
    file.commit();
    return read_whole(folder / "file");
}

/// A block of columns of `height` nodes at y = 0, z = 1, one a row in x from `x` on.
inline ParticleBlock columns(ParticleType type, int mk, std::uint32_t x, std::uint32_t columns,
                             std::uint32_t height)
{
    ParticleBlock block;
    block.type = type;
    block.mk = static_cast<std::uint16_t>(mk);
    block.mk_type = static_cast<std::uint16_t>(type == ParticleType::Fluid ? mk - 1 : mk - 10);
    for (std::uint32_t i = 0; i < columns; ++i) block.runs.push_back({x + i, 0, 1, height, 0});
    block.count = std::uint64_t{columns} * height;
    return block;
}

/// The case of these blocks, ids given in their order.
inline CaseParticles make_particles(std::vector<ParticleBlock> blocks)
{
    CaseParticles particles;
    particles.grid.origin = {-0.1, 0.25, 0.3};
    particles.grid.dp = 0.1;
    std::uint32_t highest = 0;
    for (ParticleBlock& block : blocks)
    {
        block.begin = particles.np;
        particles.np += block.count;
        (block.type == ParticleType::Fixed      ? particles.n_fixed
         : block.type == ParticleType::Moving   ? particles.n_moving
         : block.type == ParticleType::Floating ? particles.n_floating
                                                : particles.n_fluid) += block.count;
        for (const ParticleRun& run : block.runs)
            if (block.type == ParticleType::Fluid)
                highest = std::max(highest, run.depth + run.count);
    }
    particles.blocks = std::move(blocks);
    for (std::uint32_t depth = 0; depth < highest; ++depth)
        particles.rhop_of_depth.push_back(1000.0f + static_cast<float>(depth));
    return particles;
}

/// Three fixed, two moving, four floating and two blocks of fluid, 8 + 6.
inline CaseParticles small_particles()
{
    ParticleBlock descending = columns(ParticleType::Fluid, 2, 20, 2, 3);
    descending.run_descending = true;
    for (ParticleRun& run : descending.runs) run.z = 5;
    descending.runs[1].depth = 4;
    CaseParticles particles = make_particles(
        {columns(ParticleType::Fixed, 10, 0, 1, 3), columns(ParticleType::Moving, 11, 3, 1, 2),
         columns(ParticleType::Floating, 15, 5, 2, 2), columns(ParticleType::Fluid, 1, 8, 4, 2),
         std::move(descending)});
    particles.blocks[1].ref_motion = 0;
    return particles;
}

/// small_particles() with a fitted wall: a run of two particles off the lattice in the middle of
/// the moving block and one of three at the end of the fluid, of all kinds.
inline CaseParticles walled_particles()
{
    CaseParticles particles = small_particles();
    std::vector<ParticleBlock> blocks = std::move(particles.blocks);
    blocks[1].runs = {{3, 0, 1, 1, 0}, ParticleRun::of_off_lattice(0, 2), {3, 0, 2, 1, 0}};
    blocks[1].count += 2;
    blocks[4].runs.push_back(ParticleRun::of_off_lattice(2, 3));
    blocks[4].count += 3;
    particles = make_particles(std::move(blocks));
    particles.has_walls = true;
    particles.off_lattice.positions = {
        {0.2, 0.25, 0.41}, {0.2, 0.25, 1.0 / 3}, {2.1, 0.3, 0.5}, {2.2, 0.3, 0.5}, {2.3, 0.3, 0.5}};
    particles.off_lattice.kinds = {FitKind::Corner, FitKind::Edge, FitKind::Surface,
                                   FitKind::Volume, FitKind::Volume};
    particles.off_lattice.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0.6F, 0.8F}, {0, 0, 0}, {0, 0, 0}};
    particles.off_lattice.distances = {0, 1e-17F, -1e-17F, 0.1F, 0.2F};
    particles.off_lattice.layers = {1, 2, 3, 0, 0};
    particles.off_lattice.rhop = {999, 999, 1010, 1011, 1012};
    return particles;
}

inline CaseConstants small_constants()
{
    CaseConstants constants;
    constants.gravity = {0, 0, -9.81};
    constants.cfl_number = 0.2;
    constants.gamma = 7;
    constants.rhop0 = 999;
    constants.dp = 0.1;
    constants.h = 0.1 * 1.7320508075688772;
    constants.b = 100000.5;
    constants.mass_bound = constants.mass_fluid = 0.999;
    return constants;
}

} // namespace fppg
