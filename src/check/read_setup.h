#pragma once

#include "fppg/check.h"
#include "fppg/element.h"

#include <string>

namespace fppg
{

/// Reads constants, parameters, domain and buffer zones from the tree of Case.xml.
///
/// path       for messages
/// particles  the box of all particles: the default of the domain
/// throws     CaseError with file and line where a number is missing or is none
CheckSetup read_setup(const Element& root, const std::string& path, const Box3& particles);

} // namespace fppg
