#include "app/inspect_command.h"

#include <fmt/format.h>

#include "app/inspect.h"
#include "app/stage_bar.h"
#include "app/subcommand_line.h"
#include "app/threads.h"
#include "fppg/error.h"
#include "meshes/mesh_formats.h"

#include <optional>

namespace fppg
{

int run_inspect(const std::vector<std::string>& arguments)
{
    SubcommandLine app(
        "Says what a mesh file holds, what is wrong with it, and how many particles it needs",
        "fppg inspect");
    InspectOptions inspect;
    bool as_json = false;
    app.add_option("mesh", inspect.path, "a mesh file: " + mesh_format_list()).required();
    app.add_option("--part", inspect.parts,
                   "of a STEP file: names of parts or assemblies, separated by commas");
    app.add_option("--dp", inspect.dp, "particle distance, in the unit of the file").positive();
    app.add_option("--unit", inspect.unit,
                   "what a length in the file is; it is guessed otherwise (STEP: read as m)")
        .one_of({"m", "cm", "mm", "in"});
    double angle = -1;
    app.add_option("--angle", angle,
                   "feature angle, degrees (30; 1 between the exact faces of STEP files)")
        .range(0.0, 179.999);
    app.add_option("--weld", inspect.weld_distance,
                   "weld vertices nearer than this, in the unit of the file");
    app.add_option("--threads", inspect.threads, "threads (0: what the machine allows)");
    app.add_flag("--json", as_json, "print JSON");
    if (!app.read(arguments)) return 0;
    if (angle >= 0) inspect.angle_deg = inspect.cad_angle_deg = angle;
    if (inspect.threads <= 0) inspect.threads = default_threads();
    std::optional<StageBar> bar(std::in_place, "inspect");
    const Inspection inspection = inspect_mesh(inspect);
    bar.reset();
    fmt::print("{}", as_json ? to_json(inspection) : to_text(inspection));
    return 0;
}

} // namespace fppg
