#pragma once

#include <string>

namespace fppg
{

/// The commented case that -templates writes: xml-templates/FppgCaseTemplate.xml, built in.
std::string case_template_text();

} // namespace fppg
