#pragma once

#include "files/bi4_view.h"
#include "files/case_facts.h"

#include <string>

namespace fppg
{

/// The two files of a result that only mean something together.
struct ResultPair
{
    std::string bi4;
    std::string xml;
};

/// throws  IoError if Case.xml is not there; it says so where a run was killed while it replaced
///         the files (a run takes the old Case.xml away before the first new file has its name)
void expect_case_xml(const ResultPair& pair);

/// Whether both were written by one run, as far as they say: how many particles of each type, and
/// between which limits.
///
/// throws  IoError where they differ
void expect_one_run(const ResultPair& pair, const CaseFacts& facts, const Bi4View& bi4);

} // namespace fppg
