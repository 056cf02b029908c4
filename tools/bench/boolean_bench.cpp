// Times the Boolean test of the FPPG paper: parts united in sets, and the sets taken out of a box
// that is put around them.
//
//   boolean_bench DP [threads] [repeat] SET... where SET is a.stl[@x,y,z]+b.stl[@x,y,z]+...
//
// The generation is what is done with or without the Boolean: taking in the meshes, particles on
// the surface, nodes inside; no relaxation. The Boolean is the cutting of surfaces and the interval
// operations on nodes.

#include "fppg/boolean.h"
#include "fppg/shapes.h"
#include "lattice/wall_painter.h"
#include "walls/fit_shape.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <fstream>
#include <map>
#include <string>

namespace
{

using fppg::Vec3;

/// Seconds and the highest resident memory, MB, of stages in the order of their first run. Ratios
/// are of processor time, which other users of the machine change less.
class Stages
{
public:
    template <class Work>
    auto run(const std::string& name, Work&& work)
    {
        // Linux counts the highest memory anew from here.
        std::ofstream("/proc/self/clear_refs") << "5";
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t cpu_start = std::clock();
        auto result = work();
        const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
        const double wall =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (samples_.count(name) == 0) order_.push_back(name);
        samples_[name].push_back({wall, cpu});
        peak_[name] = std::max(peak_[name], resident("VmHWM:"));
        return result;
    }

    double wall(const std::string& name) const { return median(name, 0); }
    double cpu(const std::string& name) const { return median(name, 1); }

    void print() const
    {
        for (const std::string& name : order_)
            std::printf("  %-28s %8.3f s of processor, %8.3f s, memory up to %6.0f MB\n",
                        name.c_str(), cpu(name), wall(name), peak_.at(name));
    }

private:
    double median(const std::string& name, std::size_t which) const
    {
        std::vector<double> sorted;
        for (const auto& sample : samples_.at(name)) sorted.push_back(sample[which]);
        std::sort(sorted.begin(), sorted.end());
        return sorted[sorted.size() / 2];
    }

    static double resident(const std::string& key)
    {
        std::ifstream status("/proc/self/status");
        for (std::string line; std::getline(status, line);)
            if (line.rfind(key, 0) == 0) return std::atof(line.c_str() + key.size()) / 1024;
        return 0;
    }

    std::vector<std::string> order_;
    std::map<std::string, std::vector<std::array<double, 2>>> samples_;
    std::map<std::string, double> peak_;
};

fppg::TriangleSoup read_part(const std::string& word)
{
    const auto at = word.find('@');
    fppg::TriangleSoup soup = fppg::read_stl(word.substr(0, at)).soup;
    Vec3 move;
    if (at != std::string::npos &&
        std::sscanf(word.c_str() + at, "@%lf,%lf,%lf", &move.x, &move.y, &move.z) != 3)
    {
        std::fprintf(stderr, "boolean_bench: %s: expected file@x,y,z\n", word.c_str());
        std::exit(2);
    }
    for (Vec3& v : soup.vertices) v = v + move;
    return soup;
}

fppg::TriangleSoup box_of(const Vec3& low, const Vec3& high)
{
    fppg::TriangleSoup soup;
    const auto corner = [&](int k) {
        return Vec3{k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
    };
    for (const auto& [a, b, c] :
         {std::array{0, 2, 3}, std::array{0, 3, 1}, std::array{4, 5, 7}, std::array{4, 7, 6},
          std::array{0, 1, 5}, std::array{0, 5, 4}, std::array{2, 6, 7}, std::array{2, 7, 3},
          std::array{0, 4, 6}, std::array{0, 6, 2}, std::array{1, 3, 7}, std::array{1, 7, 5}})
        for (const int k : {a, b, c}) soup.vertices.push_back(corner(k));
    return soup;
}

std::size_t count_nodes(const fppg::SpanSet& set)
{
    std::size_t count = 0;
    for (const auto& slab : set.slabs)
        for (const fppg::Span& span : slab) count += span.z_end - span.z_begin;
    return count;
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<std::string> sets;
    std::vector<double> numbers;
    for (int i = 1; i < argc; ++i)
    {
        const std::string word = argv[i];
        if (word.find(".stl") == std::string::npos)
            numbers.push_back(std::atof(argv[i]));
        else
            sets.push_back(word);
    }
    if (sets.empty() || numbers.empty() || !(numbers[0] > 0))
    {
        std::fprintf(stderr, "usage: boolean_bench DP [threads] [repeat] a.stl+b.stl@x,y,z ...\n");
        return 2;
    }
    const double dp = numbers[0];
    const int threads = numbers.size() > 1 ? static_cast<int>(numbers[1]) : 1;
    const int repeat = numbers.size() > 2 ? static_cast<int>(numbers[2]) : 1;

    // The box is part 0, the sets are taken out of it.
    std::deque<fppg::TriangleSoup> soups{{}};
    fppg::BooleanNode tree;
    tree.op = fppg::BooleanOp::Difference;
    tree.operands.emplace_back();
    Vec3 low{1e300, 1e300, 1e300};
    Vec3 high{-1e300, -1e300, -1e300};
    for (const std::string& set : sets)
    {
        fppg::BooleanNode united;
        united.op = fppg::BooleanOp::Union;
        for (std::size_t begin = 0; begin < set.size();)
        {
            const std::size_t end = std::min(set.find('+', begin), set.size());
            fppg::BooleanNode leaf;
            leaf.part = static_cast<std::uint32_t>(soups.size());
            soups.push_back(read_part(set.substr(begin, end - begin)));
            for (const Vec3& v : soups.back().vertices)
                for (int axis = 0; axis < 3; ++axis)
                {
                    low[axis] = std::min(low[axis], v[axis]);
                    high[axis] = std::max(high[axis], v[axis]);
                }
            united.operands.push_back(leaf);
            begin = end + 1;
        }
        tree.operands.push_back(united);
    }
    const double margin = 0.05 * norm(high - low);
    low = low - Vec3{margin, margin, margin};
    high = high + Vec3{margin, margin, margin};
    soups[0] = box_of(low, high);

    fppg::LatticeGrid grid;
    grid.dp = dp;
    for (int axis = 0; axis < 3; ++axis)
    {
        grid.origin[axis] = low[axis] - 2.5 * dp;
        grid.n[static_cast<std::size_t>(axis)] =
            static_cast<std::uint32_t>((high[axis] - low[axis]) / dp + 6);
    }
    fppg::FitSettings settings;
    fppg::FeatureOptions feature_options;
    feature_options.dp = dp;

    Stages stages;
    std::size_t walls = 0;
    std::size_t nodes_inside = 0;
    std::size_t facets = 0;
    for (int r = 0; r < repeat; ++r)
    {
        const auto meshes =
            stages.run("meshes taken in",
                       [&]
                       {
                           std::deque<fppg::SurfaceMesh> out;
                           fppg::MeshReport report;
                           for (const auto& soup : soups)
                               out.push_back(fppg::repair_mesh(soup, {}, threads, report));
                           return out;
                       });
        std::vector<fppg::BooleanPart> parts;
        for (const auto& mesh : meshes) parts.push_back({"part", &mesh, false});
        auto combined = stages.run("Boolean of surfaces",
                                   [&] { return fppg::boolean_mesh(parts, tree, {}, threads); });
        facets = combined.mesh.facets.size();
        fppg::FittedBody body;
        body.is_solid = true;
        body.mesh = std::move(combined.mesh);
        body.report = std::move(combined.report);
        const auto draw = stages.run(
            "particles on the surface",
            [&]
            {
                body.features = fppg::find_features(body.mesh, feature_options, combined.seams);
                return fppg::fit_body(std::move(body), settings, grid, {}, threads);
            });
        const auto sets_of_nodes =
            stages.run("nodes inside the parts",
                       [&]
                       {
                           std::vector<fppg::SpanSet> out;
                           for (const auto& mesh : meshes)
                               out.push_back(fppg::solid_nodes(mesh, grid, threads));
                           return out;
                       });
        const auto shares =
            stages.run("Boolean of nodes",
                       [&]
                       {
                           const auto nodes = fppg::boolean_spans(sets_of_nodes, tree, threads);
                           return fppg::share_out(nodes, sets_of_nodes, tree, threads);
                       });
        walls = draw.particles.size();
        nodes_inside = 0;
        for (const fppg::Spans& slab : draw.volume)
            for (const fppg::Span& span : slab) nodes_inside += span.z_end - span.z_begin;
        if (count_nodes(shares[0]) < nodes_inside)
            std::fprintf(stderr, "boolean_bench: the Boolean of nodes lacks some\n");
    }
    const double boolean = stages.cpu("Boolean of surfaces") + stages.cpu("Boolean of nodes");
    const double generation = stages.cpu("meshes taken in") +
                              stages.cpu("particles on the surface") +
                              stages.cpu("nodes inside the parts");
    std::printf("%zu particles (%zu on the surface) at dp %g, %zu facets left, %d threads\n",
                walls + nodes_inside, walls, dp, facets, threads);
    stages.print();
    std::printf("  Boolean %.3f s, generation %.3f s of processor: %.1f %%\n", boolean, generation,
                100 * boolean / generation);
    return 0;
}
