#pragma once

#include "fppg/convert.h"
#include "fppg/element.h"

#include <vector>

namespace fppg
{

/// Gives every body a name: that of its mk (`name` of setmkbound and setmkfluid), else the only
/// name of its draws (`fppg:name` or `objname`), else "bound0" or "fluid1". Of equal ones, the
/// later get
/// "_MK" behind them. The commands are those of `<mainlist>` and the lists that it runs; an mk that
/// is no plain number names nothing.
///
/// casedef   `<casedef>`
/// mk_types  mkbound or mkfluid of every body
void name_bodies(const Element& casedef, const std::vector<std::uint16_t>& mk_types,
                 std::vector<FeedBody>& bodies);

} // namespace fppg
