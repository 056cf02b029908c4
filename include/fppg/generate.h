#pragma once

#include "fppg/convert.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// What stands in place of, or beside, what a definition says.
struct GenerateOptions
{
    std::optional<double> dp{}; ///< metres
    std::vector<std::pair<std::string, std::string>> vars{};
    FitChoice fit = FitChoice::AsCase;
    int threads = 0;     ///< 0: what the machine or its scheduler allows
    bool strict = false; ///< warnings where GenCase is silent are errors
    /// Told of the stage ("Draw", "Relax", "PreparePoints", ...) and the share of it that is done,
    /// 0 to 1, by the thread that called. What it throws ends the work and is passed on.
    std::function<void(const std::string& stage, double share)> on_progress{};
};

/// The particles of a definition in memory, as a run of the program makes them.
class GeneratedCase
{
public:
    GeneratedCase();
    ~GeneratedCase();
    GeneratedCase(GeneratedCase&&) noexcept;
    GeneratedCase& operator=(GeneratedCase&&) noexcept;

    const CaseDef& def() const;
    const CaseParticles& particles() const;
    const CaseConstants& constants() const;
    const std::vector<std::string>& warnings() const; ///< whole sentences

    /// Writes OUTPUT.bi4 and OUTPUT.xml, the meshes beside them, and the particles for other codes,
    /// all or none; folders are made.
    ///
    /// to       names of particle_formats()
    /// returns  the files
    /// throws   IoError, UsageError for an unknown format
    std::vector<std::string> save(const std::string& output, const std::vector<std::string>& to);

private:
    friend GeneratedCase generate_case(const std::string&, const GenerateOptions&);
    struct State;
    std::unique_ptr<State> state_;
};

/// Makes the particles of a definition; nothing is written.
///
/// definition  Case_Def.xml, with or without its ending
/// throws      CaseError for a wrong definition, and for one with `<vres>`, the zones of which only
///             the program makes; GeometryError, IoError; what on_progress throws
GeneratedCase generate_case(const std::string& definition, const GenerateOptions& options);

} // namespace fppg
