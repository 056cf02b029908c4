// Times every stage by itself, on the repository's own cases and on generated ones, with one thread
// and with two. Counters: particles/s or triangles/s, bytes/s for files, and peak_rss_MB, the
// highest memory of the whole process while this stage was repeated (its input is part of it).

#include "generated_cases.h"

#include "fppg/boolean.h"
#include "fppg/case_def.h"
#include "fppg/files.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/scene.h"
#include "fppg/shapes.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <malloc.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace
{

using benchmark::Counter;
using benchmark::State;

/// Lets the kernel count the peak memory of this process anew. Memory that was freed but kept for
/// later is given back first, so that it does not count for the next stage.
void reset_peak_memory()
{
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_memory_mb()
{
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word)
        if (word == "VmHWM:")
        {
            double kib = 0;
            status >> kib;
            return kib * 1024 / 1e6;
        }
    return 0;
}

/// Calls `body` as often as the state asks for and gives the counter of `count` things a call.
template <typename Body>
void time_stage(State& state, const char* things, std::uint64_t count, const Body& body)
{
    reset_peak_memory();
    for (auto _ : state) body();
    state.counters["peak_rss_MB"] = peak_memory_mb();
    state.counters[std::string(things) + "/s"] =
        Counter(static_cast<double>(count), Counter::kIsIterationInvariantRate);
    state.counters[things] = static_cast<double>(count);
}

/// What the stages make of one case, up to the particles.
struct Made
{
    fppg::CaseDef def;
    fppg::RunField field;
    fppg::CaseParticles particles;
    fppg::CaseConstants constants;
    std::vector<fppg::ParticleType> type_of_mk = std::vector<fppg::ParticleType>(65536);
};

fppg::CaseDef read(const std::string& path, double dp)
{
    fppg::CaseOptions options;
    options.case_name = "Case";
    if (dp > 0) options.dp = dp;
    return fppg::read_case(path, options);
}

Made make(const std::string& path, double dp)
{
    Made made;
    made.def = read(path, dp);
    fppg::LatticeReport report;
    made.field = fppg::draw_scene(make_scene(made.def), 1, {}, report);
    std::vector<std::string> warnings;
    fppg::RunField field = made.field;
    made.particles = fppg::make_particles(made.def, field, 1, made.constants, warnings);
    for (const fppg::ParticleBlock& block : made.particles.blocks)
        made.type_of_mk[block.mk] = block.type;
    return made;
}

/// A case of the benchmark. Only the last one used is kept in memory.
class Case
{
public:
    Case(std::string name, std::string path, double dp)
        : name_(std::move(name)), path_(std::move(path)), dp_(dp)
    {
    }

    const std::string& name() const { return name_; }
    const std::string& path() const { return path_; }
    double dp() const { return dp_; }
    const Made& made() const
    {
        static const Case* last = nullptr;
        static std::unique_ptr<Made> kept;
        if (last != this)
        {
            kept.reset();
            kept = std::make_unique<Made>(make(path_, dp_));
            last = this;
        }
        return *kept;
    }

private:
    std::string name_;
    std::string path_;
    double dp_;
};

using CaseRef = std::shared_ptr<const Case>;
using CaseBody = std::function<void(State&, const Made&, int threads)>;

void add(const std::string& name, const std::function<void(State&, int)>& body)
{
    for (const int threads : {1, 2})
        benchmark::RegisterBenchmark(fmt::format("{}/threads:{}", name, threads).c_str(),
                                     [body, threads](State& state) { body(state, threads); })
            ->UseRealTime()
            ->MeasureProcessCPUTime()
            ->Unit(benchmark::kMillisecond);
}

void add(const char* stage, const CaseRef& what, const CaseBody& body)
{
    add(fmt::format("{}/{}", stage, what->name()),
        [what, body](State& state, int threads) { body(state, what->made(), threads); });
}

void add_reading(const CaseRef& what)
{
    benchmark::RegisterBenchmark(
        fmt::format("read_case/{}", what->name()).c_str(),
        [what](State& state)
        {
            time_stage(state, "draws", read(what->path(), what->dp()).ops.size(),
                       [&] { benchmark::DoNotOptimize(read(what->path(), what->dp())); });
        })
        ->Unit(benchmark::kMillisecond);
}

void add_generating(const CaseRef& what)
{
    add("draw_scene", what,
        [](State& state, const Made& made, int threads)
        {
            time_stage(state, "particles", made.particles.np,
                       [&]
                       {
                           fppg::LatticeReport report;
                           benchmark::DoNotOptimize(
                               fppg::draw_scene(make_scene(made.def), threads, {}, report));
                       });
        });
}

void add_numbering(const CaseRef& what)
{
    add("make_particles", what,
        [](State& state, const Made& made, int threads)
        {
            time_stage(state, "particles", made.particles.np,
                       [&]
                       {
                           state.PauseTiming();
                           fppg::RunField field = made.field;
                           state.ResumeTiming();
                           fppg::CaseConstants constants;
                           std::vector<std::string> warnings;
                           benchmark::DoNotOptimize(
                               fppg::make_particles(made.def, field, threads, constants, warnings));
                       });
        });
}

using Write = std::function<void(fppg::OutputFile&, const Made&, int threads)>;

/// Writes a new file each time. What was written stays in the memory of the system: it is the
/// program that is timed here, not the disk.
void add_writing(const char* stage, const CaseRef& what, const std::shared_ptr<WorkFolder>& work,
                 const Write& write)
{
    add(stage, what,
        [work, write](State& state, const Made& made, int threads)
        {
            const std::string path = work->file("written");
            time_stage(state, "particles", made.particles.np,
                       [&]
                       {
                           state.PauseTiming();
                           std::filesystem::remove(path);
                           state.ResumeTiming();
                           fppg::OutputFile file(path);
                           write(file, made, threads);
                           file.commit();
                       });
            state.counters["bytes/s"] =
                Counter(static_cast<double>(std::filesystem::file_size(path)),
                        Counter::kIsIterationInvariantRate, Counter::kIs1000);
            std::filesystem::remove(path);
        });
}

void add_files(const CaseRef& what, const std::shared_ptr<WorkFolder>& work)
{
    add_writing(
        "write_bi4", what, work,
        [](fppg::OutputFile& file, const Made& made, int threads) {
            fppg::write_bi4(file, made.particles, made.constants, {"bench", "", "Case"}, threads);
        });
    add_writing("write_particles_vtk", what, work,
                [](fppg::OutputFile& file, const Made& made, int threads)
                {
                    fppg::write_particles_vtk(file, made.particles, made.constants,
                                              fppg::VtkSelection::All, threads);
                });
    add_writing("write_cells_vtk", what, work,
                [](fppg::OutputFile& file, const Made& made, int threads)
                { fppg::write_cells_vtk(file, made.field, made.type_of_mk, threads); });
}

void add_meshes(const std::shared_ptr<WorkFolder>& work)
{
    for (const std::size_t rings : {50, 400})
        for (const bool is_binary : {true, false})
        {
            const std::string path =
                work->file(fmt::format("sphere{}{}.stl", rings, is_binary ? "" : "text"));
            write_sphere_stl(path, rings, is_binary);
            const std::string name =
                fmt::format("{}_{}_facets", is_binary ? "binary" : "text", sphere_facets(rings));
            add("read_stl/" + name,
                [path, rings](State& state, int threads)
                {
                    time_stage(state, "triangles", sphere_facets(rings),
                               [&] { benchmark::DoNotOptimize(fppg::read_stl(path, threads)); });
                });
            if (!is_binary) continue;
            add("boolean_mesh/union_of_two_" + name,
                [path, rings](State& state, int threads)
                {
                    fppg::TriangleSoup soup = fppg::read_stl(path).soup;
                    fppg::MeshReport report;
                    const fppg::SurfaceMesh one = fppg::repair_mesh(soup, {}, threads, report);
                    for (fppg::Vec3& v : soup.vertices) v = v + fppg::Vec3{0.21, 0.13, 0.17};
                    const fppg::SurfaceMesh two = fppg::repair_mesh(soup, {}, threads, report);
                    fppg::BooleanNode both;
                    both.op = fppg::BooleanOp::Union;
                    both.operands.resize(2);
                    both.operands[1].part = 1;
                    time_stage(
                        state, "triangles", 2 * sphere_facets(rings),
                        [&]
                        {
                            benchmark::DoNotOptimize(fppg::boolean_mesh(
                                {{"one", &one, false}, {"two", &two, false}}, both, {}, threads));
                        });
                });
            for (const std::uint32_t nodes : {100U, 400U})
                add(fmt::format("inside_spans/{}_in_{}^3_nodes", name, nodes),
                    [path, rings, nodes](State& state, int threads)
                    {
                        const fppg::TriangleSoup soup = fppg::read_stl(path).soup;
                        const fppg::LatticeGrid grid{
                            {0, 0, 0}, 1.0 / nodes, {nodes, nodes, nodes}, false};
                        time_stage(
                            state, "triangles", sphere_facets(rings),
                            [&]
                            { benchmark::DoNotOptimize(fppg::inside_spans(soup, grid, threads)); });
                    });
        }
}

struct Draws
{
    const char* name;
    std::string commands;
};

std::vector<Draws> generated_draws()
{
    const std::string walls =
        "<setdrawmode mode=\"face\" /><setmkbound mk=\"0\" /><drawbox><boxfill>all</boxfill>"
        "<point x=\"0.1\" y=\"0.1\" z=\"0.1\" /><size x=\"0.8\" y=\"0.8\" z=\"0.8\" /></drawbox>";
    const std::string box =
        "<setdrawmode mode=\"solid\" /><setmkfluid mk=\"0\" /><drawbox><boxfill>solid</boxfill>"
        "<point x=\"0.1\" y=\"0.1\" z=\"0.1\" /><size x=\"0.8\" y=\"0.8\" z=\"0.8\" /></drawbox>";
    const std::string shell =
        "<setdrawmode mode=\"face\" /><setmkbound mk=\"1\" /><drawfilestl file=\"sphere400.stl\" "
        "/>";
    const std::string fill =
        "<setmkfluid mk=\"0\" /><fillpoint x=\"0.12\" y=\"0.12\" z=\"0.12\">"
        "<modefill>void</modefill></fillpoint>";
    const std::string near =
        "<setmkbound mk=\"2\" /><redrawnear targettp=\"void\" bordertp=\"fluid\" />";
    return {{"box", box},
            {"sphere",
             "<setdrawmode mode=\"solid\" /><setmkfluid mk=\"0\" />"
             "<drawsphere radius=\"0.4\"><point x=\"0.5\" y=\"0.5\" z=\"0.5\" /></drawsphere>"},
            {"stl_shell", shell},
            {"fill", walls + fill},
            {"fill_around_stl", walls + shell + fill},
            {"redraw_near", box + near}};
}

void register_all(const std::shared_ptr<WorkFolder>& work)
{
    std::vector<CaseRef> cases;
    const std::string folder = FPPG_CASES_DIR;
    const auto own = [&](const char* name, const char* path, double dp)
    { cases.push_back(std::make_shared<Case>(name, folder + path, dp)); };
    own("dambreak", "/dambreak/CaseDambreak_Def.xml", 0);
    own("dambreak_dp0.003", "/dambreak/CaseDambreak_Def.xml", 0.003);
    own("dambreak2d_dp0.002", "/dambreak2d/CaseDambreak2D_Def.xml", 0.002);
    own("tank", "/tank/CaseTank_Def.xml", 0);
    own("tank_dp0.0035", "/tank/CaseTank_Def.xml", 0.0035);
    own("ford", "/ford/CaseFord_Def.xml", 0);
    own("ford_dp0.017", "/ford/CaseFord_Def.xml", 0.017);
    for (const CaseRef& c : cases)
    {
        add_reading(c);
        add_generating(c);
        add_numbering(c);
        add_files(c, work);
    }
    add_meshes(work);
    for (const Draws& draws : generated_draws())
        for (const double dp : {0.01, 0.0025})
        {
            const std::string path = work->file(fmt::format("{}_{}.xml", draws.name, dp));
            write_definition(path, dp, draws.commands);
            add_generating(std::make_shared<Case>(fmt::format("{}_dp{}", draws.name, dp), path, 0));
        }
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        benchmark::Initialize(&argc, argv);
        if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
        const auto work = std::make_shared<WorkFolder>();
        register_all(work);
        benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
    }
    catch (const std::exception& error)
    {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
