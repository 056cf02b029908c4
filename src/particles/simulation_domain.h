#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// Moves limits of `<simulationdomain>` that are given in metres and lie within the particles of
/// fitted walls to a dp beyond these: layers stand behind the surface that the limits were chosen
/// for, and the solver refuses particles beyond (v5.4, JSph::ResizeMapLimits: the limits must hold
/// all particles and 0.05 h around them).
///
/// def       its execution is changed
/// returns   one line for each limit that was moved; none without fitted walls, or with `<vres>`
std::vector<std::string> widen_simulation_domain(const CaseParticles& particles, CaseDef& def);

/// What the domain of the solver depends on besides the parameters of a case.
struct DomainFacts
{
    Box3 particles; ///< of all of them at the start
    double dp = 0;
    double h = 0;
    std::array<bool, 3> is_periodic{};
    bool is_2d = false;
};

/// The domain of the solver v5.4: the box of all particles, half a dp wider along periodic axes and
/// 0.05 h along others, with what `<simulationdomain>` adds to these or gives in their place. The
/// solver ends where a particle of a wall leaves it, wherever `<pointmin>` and `<pointmax>` are.
///
/// parameters  `<parameters>` of the case
/// path        of its file, for errors
/// returns     an empty box without particles
/// throws      CaseError for a limit that is neither "default", "default + 0.5", "default + 10%" (-
///             for the least) nor a number
Box3 solver_domain(const Element& parameters, const std::string& path, const DomainFacts& facts);

/// The same of a case that was made; nothing where old keys give it.
std::optional<Box3> solver_domain(const CaseDef& def, const CaseParticles& particles);

/// Whether keys of old definitions, which solver_domain() does not know, give the domain.
bool has_old_domain(const Element& parameters);

} // namespace fppg
