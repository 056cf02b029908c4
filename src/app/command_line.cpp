#include "app/command_line.h"

#include "core/nearest_word.h"
#include "core/text.h"
#include "fppg/convert.h"
#include "fppg/error.h"
#include "fppg/version.h"
#include "platform/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace fppg
{
namespace
{

template <typename Number>
Number number_of(const std::string& option, const std::string& value, const char* expected)
{
    Number n{};
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), n);
    if (error != std::errc() || end != value.data() + value.size())
        throw UsageError(
            fmt::format("{}: \"{}\" is invalid, expected {}", option, value, expected));
    return n;
}

bool flag_of(const std::string& option, const std::string& value)
{
    if (value.empty() || value == "1" || value == "true") return true;
    if (value == "0" || value == "false") return false;
    throw UsageError(fmt::format("{}: \"{}\" is invalid, expected 0 or 1", option, value));
}

void choose_formats(const std::string& list, DropInOptions& options)
{
    if (list == "none")
    {
        options.save_nothing = true;
        options.save_cells = options.save_off_lattice_points = false;
        return;
    }
    for (std::string_view word : split(list, ','))
    {
        bool on = true;
        if (!word.empty() && (word[0] == '+' || word[0] == '-'))
        {
            on = word[0] == '+';
            word.remove_prefix(1);
        }
        const bool all = word == "all";
        if (!all && word != "bi" && word != "vtkcells" && word != "vtkfreept" && word != "vtkall" &&
            word != "vtkbound" && word != "vtkfluid" && word != "vtkfeatures" && word != "relaxcsv")
            throw UsageError(fmt::format(
                "-save: \"{}\" is unknown, expected all, bi, vtkcells, vtkfreept, vtkall, "
                "vtkbound, vtkfluid, vtkfeatures or relaxcsv, each with + or - before it, or none "
                "alone",
                word));
        if (all || word == "bi") options.save_bi4 = on;
        if (all || word == "vtkcells") options.save_cells = on;
        if (all || word == "vtkfreept") options.save_off_lattice_points = on;
        if (all || word == "vtkall") options.save_all = on;
        if (all || word == "vtkbound") options.save_bound = on;
        if (all || word == "vtkfluid") options.save_fluid = on;
        if (all || word == "vtkfeatures") options.save_features = on;
        if (all || word == "relaxcsv") options.save_relaxation = on;
    }
}

/// Formats of other codes; each counts once.
void choose_conversions(const std::string& list, DropInOptions& options)
{
    for (const std::string_view word : split(list, ','))
    {
        const std::string name = find_particle_format(std::string(word), "-to").name;
        if (std::find(options.to.begin(), options.to.end(), name) == options.to.end())
            options.to.push_back(name);
    }
}

FitChoice fit_choice_of(const std::string& value, bool has_value)
{
    if (!has_value) return FitChoice::On;
    if (value == "raw") return FitChoice::Raw;
    if (value == "off") return FitChoice::Off;
    throw UsageError(
        fmt::format("-fit: \"{}\" is invalid, expected -fit, -fit:raw or -fit:off", value));
}

/// An option of a run and what may stand behind it.
struct OptionForm
{
    enum class Value
    {
        None,
        Optional, ///< one of a few words
        Needed,
    };
    std::string_view name;
    Value value = Value::None;
    std::string_view example{}; ///< of a value
};

constexpr std::array<OptionForm, 20> option_forms{{
    {"h"},
    {"help"},
    {"ver"},
    {"version"},
    {"info"},
    {"templates"},
    {"overwrite"},
    {"clean"},
    {"strict"},
    {"quiet"},
    {"log-json"},
    {"fit", OptionForm::Value::Optional, "raw"},
    {"dp", OptionForm::Value::Needed, "0.01"},
    {"evars", OptionForm::Value::Needed, "A=1"},
    {"threads", OptionForm::Value::Needed, "4"},
    {"memory", OptionForm::Value::Needed, "8"},
    {"save", OptionForm::Value::Needed, "all"},
    {"to", OptionForm::Value::Needed, "vtu"},
    {"save3vtk", OptionForm::Value::Needed, "1"},
    {"createdirs", OptionForm::Value::Needed, "1"},
}};

const OptionForm* form_of(std::string_view name)
{
    const auto* form = std::find_if(option_forms.begin(), option_forms.end(),
                                    [&](const OptionForm& f) { return f.name == name; });
    return form == option_forms.end() ? nullptr : form;
}

/// Arguments such as `--dp 0.01`, `--dp=0.01` and `--fit raw` in GenCase's form, `-dp:0.01`.
std::vector<std::string> in_gencase_form(const std::vector<std::string>& arguments)
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < arguments.size(); ++i)
    {
        const std::string& a = arguments[i];
        const std::size_t equals = a.find_first_of("=:");
        const bool is_long = a.starts_with("--");
        const bool has_next = i + 1 < arguments.size();
        const std::size_t begin = is_long ? 2 : 1;
        const OptionForm* form = a.size() > begin && a[0] == '-'
                                     ? form_of(a.substr(begin, is_long ? equals - begin : a.size()))
                                     : nullptr;
        if (form == nullptr || (!is_long && form->value != OptionForm::Value::Needed))
            out.push_back(a);
        else if (is_long && equals != std::string::npos)
            out.push_back(fmt::format("-{}:{}", form->name, a.substr(equals + 1)));
        else if (!is_long || (form->value == OptionForm::Value::Needed && !has_next))
            throw UsageError(fmt::format("{} needs a value: -{}:{} or --{} {}", a, form->name,
                                         has_next ? arguments[i + 1] : std::string(form->example),
                                         form->name,
                                         has_next ? arguments[i + 1] : std::string(form->example)));
        else if (form->value == OptionForm::Value::Needed ||
                 (form->value == OptionForm::Value::Optional && has_next &&
                  (arguments[i + 1] == "raw" || arguments[i + 1] == "off")))
            out.push_back(fmt::format("-{}:{}", form->name, arguments[++i]));
        else
            out.push_back(fmt::format(
                "{}{}", form->name == "help" || form->name == "version" ? "--" : "-", form->name));
    }
    return out;
}

/// " (did you mean -strict?)"
std::string nearest_option(std::string_view name)
{
    std::vector<std::string_view> names;
    for (const OptionForm& form : option_forms) names.push_back(form.name);
    const std::string_view nearest = nearest_word(trimmed(name, "-"), names);
    return nearest.empty() ? std::string() : fmt::format(" (did you mean -{}?)", nearest);
}

void read_option(const std::string& argument, DropInOptions& options)
{
    const std::size_t colon = argument.find(':');
    const std::string name = argument.substr(0, colon);
    const std::string value = colon == std::string::npos ? "" : argument.substr(colon + 1);
    using Action = DropInOptions::Action;
    if (name == "-h" || name == "--help" || name == "-help")
        options.action = Action::Help;
    else if (name == "-ver" || name == "-version" || name == "--version")
        options.action = Action::Version;
    else if (name == "-info")
        options.action = Action::Info;
    else if (name == "-templates" || name == "-template")
        options.action = Action::Templates;
    else if (name == "-overwrite" || name == "--overwrite")
        options.overwrite = flag_of(name, value);
    else if (name == "-clean")
        options.action = Action::Clean;
    else if (name == "-dp")
    {
        options.dp = number_of<double>(name, value, "a particle distance above 0");
        if (!(*options.dp > 0) || !std::isfinite(*options.dp))
            throw UsageError(
                fmt::format("-dp: \"{}\" is invalid, expected a particle distance above 0", value));
    }
    else if (name == "-evars")
    {
        for (const std::string_view part : split(value, ':'))
        {
            const std::size_t equals = part.find('=');
            if (equals == std::string::npos || equals == 0)
                throw UsageError(
                    fmt::format("-evars: \"{}\" is invalid, expected NAME=VALUE", part));
            options.evars.emplace_back(part.substr(0, equals), part.substr(equals + 1));
        }
    }
    else if (name == "-fit")
        options.fit = fit_choice_of(value, colon != std::string::npos);
    else if (name == "-strict" || name == "--strict")
        options.strict = flag_of(name, value);
    else if (name == "-quiet" || name == "--quiet")
        options.is_quiet = flag_of(name, value);
    else if (name == "-log-json" || name == "--log-json")
        options.log_json = flag_of(name, value);
    else if (name == "-threads" || name == "-ompthreads")
    {
        options.threads = number_of<int>(name, value, "a number of threads, 0 for all");
        if (options.threads < 0 || options.threads > 4096)
            throw UsageError(
                fmt::format("-threads: {} is out of range, expected 0 to 4096", options.threads));
    }
    else if (name == "-memory")
    {
        options.memory_gb = number_of<double>(name, value, "gigabytes above 0");
        if (!(options.memory_gb > 0) || !std::isfinite(options.memory_gb))
            throw UsageError(
                fmt::format("-memory: {} is out of range, expected gigabytes above 0", value));
    }
    else if (name == "-save")
        choose_formats(value, options);
    else if (name == "-to")
        choose_conversions(value, options);
    else if (name == "-save3vtk")
        options.save_three_vtk = flag_of(name, value);
    else if (name == "-createdirs")
        options.create_folders = flag_of(name, value);
    else if (name == "-debug")
        options.debug = number_of<int>(name, value, "a debug level");
    else
        throw UsageError(fmt::format("the option {} is unknown{}; {} lists all options", argument,
                                     nearest_option(name), "fppg --help"));
}

std::string file_name(const std::string& path)
{
    const std::size_t slash = path.find_last_of(folder_ends());
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

} // namespace

DropInOptions parse_command_line(const std::vector<std::string>& arguments)
{
    DropInOptions options;
    std::vector<std::string> names;
    for (const std::string& a : in_gencase_form(arguments))
    {
        if (a.size() > 1 && a[0] == '-')
            read_option(a, options);
        else
            names.push_back(a);
    }
    if (arguments.empty()) options.action = DropInOptions::Action::Help;
    if (options.action == DropInOptions::Action::Templates)
    {
        if (names.size() > 1)
            throw UsageError(
                fmt::format("\"{}\" is one name too many, expected a folder", names[1]));
        options.output = names.empty() ? "." : names[0];
        return options;
    }
    if (options.action != DropInOptions::Action::Run &&
        options.action != DropInOptions::Action::Clean)
        return options;
    if (options.save_nothing && !options.to.empty())
        throw UsageError("-to writes files, expected it without -save:none");
    if (names.empty())
        throw UsageError("the name of the case definition is missing; see fppg --help");
    if (names.size() > 2)
        throw UsageError(fmt::format(
            "\"{}\" is one name too many, expected a definition and an output name", names[2]));
    options.input = names[0];
    // GenCase wants the name without its ending; with it the same file is meant.
    if (options.input.ends_with(".xml")) options.input.resize(options.input.size() - 4);
    options.output = names.size() == 1 ? options.input : names[1];
    const std::size_t star = options.output.find('*');
    if (names.size() == 2 && star != std::string::npos)
        options.output.replace(star, 1, file_name(options.input));
    return options;
}

CaseOptions case_options(const DropInOptions& run)
{
    CaseOptions options;
    options.fit = run.fit;
    options.dp = run.dp;
    options.evars = run.evars;
    options.case_name = file_name(run.output);
    return options;
}

std::string help_text()
{
    return fmt::format(
        "fppg {}: particles for DualSPHysics from GenCase's case definitions\n"
        "\n"
        "Usage:\n"
        "  fppg DEFINITION OUTPUT [options]     fppg CaseDambreak_Def out/CaseDambreak -save:all\n"
        "  fppg DEFINITION 'a*b' [options]      the star stands for the definition's name\n"
        "  fppg new PARTS -o Case_Def.xml       a case from CAD parts; fppg new --help\n"
        "  fppg render CASE -o picture.png      draws particles; fppg render --help\n"
        "  fppg compare A B [--html page.html]   what differs between two results; fppg compare "
        "--help\n"
        "  fppg report RESULT...                a page with pictures, histograms and a 3-D view\n"
        "  fppg inspect MESH [--dp VALUE]   what a mesh holds and what is wrong with it; fppg "
        "inspect --help\n"
        "  fppg check CASE                      normals, ghost nodes and places, judged as by the "
        "solver\n"
        "  fppg convert CASE -o FILE            particles for another code or ParaView; fppg "
        "convert --help\n"
        "  fppg leak CASE PART_FILES            fluid inside solids or outside a housing, in the "
        "solver's output\n"
        "  fppg estimate DEFINITION             particles, memory and time of a case, before it is "
        "run\n"
        "  fppg batch FOLDER                    many cases side by side; fppg batch --help\n"
        "  fppg upgrade DEFINITION              old definitions in the forms of v5.4\n"
        "  fppg templates FOLDER                writes case templates and the schema of cases\n"
        "\n"
        "Names need no extension: DEFINITION.xml is read; OUTPUT.xml, OUTPUT.bi4, "
        "OUTPUT.out and\n"
        "pictures OUTPUT_*.vtk are written. Called as GenCase_linux64 it behaves the same.\n"
        "\n"
        "Options, each as -name:value or --name value (GenCase's own, but for -fit, -strict, "
        "-quiet,\n"
        "-log-json, -memory, vtkfeatures and -overwrite):\n"
        "  -dp:VALUE              particle distance, in place of the definition's\n"
        "  -evars:A=1:B=2         new values for variables that the definition defines\n"
        "  -fit                   body-fitted walls: every boundary mk gets its particles on its "
        "true surface;\n"
        "                         mks that <fppg> in the definition names keep their settings\n"
        "  -fit:raw               the same without relaxation\n"
        "  -fit:off               no body-fitted walls, whatever <fppg> says\n"
        "  -strict                warnings about what GenCase accepts in silence are errors (exit "
        "code 3)\n"
        "  -quiet                 print warnings and errors only; OUTPUT.out holds all\n"
        "  -log-json              print one JSON object per line: stages, warnings, counts, "
        "errors\n"
        "  -threads:N             threads (default 0: what the machine or its scheduler allows)\n"
        "  -memory:GB             a run that would take more ends with an error\n"
        "  -save:LIST             files besides OUTPUT.xml, separated by commas, + or - before "
        "each:\n"
        "                         bi, vtkcells, vtkfreept (these three by default), vtkall, "
        "vtkbound,\n"
        "                         vtkfluid, vtkfeatures (feature lines of body-fitted walls, "
        "where there are\n"
        "                         any), relaxcsv (history of their relaxation), all; or none: "
        "no file is\n"
        "                         written, counts and the digests of files are printed\n"
        "  -to:LIST               particles for other codes too: vtu, xdmf, csv, pysph, "
        "sphinxsys, ...;\n"
        "                         fppg convert --help lists all\n"
        "  -save3vtk:0|1          three more copies of every VTK, _r00 to _r02 (default 0)\n"
        "  -createdirs:0|1        create the folders of OUTPUT (default 1)\n"
        "  -debug:N               accepted, changes nothing\n"
        "  -clean                 only write OUTPUT.xml, a tidy copy of the definition\n"
        "  -templates [FOLDER]    write case templates, one a feature, and the schema of cases "
        "into "
        "FOLDER\n"
        "                         (default: this one); files that differ stay, unless with "
        "-overwrite\n"
        "  -info                  what this program can do, as JSON\n"
        "  -ver, --version        the version\n"
        "  -h, --help             this text\n"
        "\n"
        "Exit code: 0 done (with or without warnings), 2 wrong usage, 3 the case or its geometry "
        "is wrong or not\n"
        "supported yet, 4 a file cannot be read or written, 5 a fault of the program, 128 + N "
        "stopped by signal N\n"
        "(130: Ctrl-C, 143: SIGTERM): the files of before stay as they were.\n",
        version);
}

} // namespace fppg
