#pragma once

// A case made and read back, with its densities.

#include "fppg/read_particles.h"

#include "helpers/bi4_array.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fppg::test
{

constexpr std::uint16_t first_bound = 10; ///< mk of mkbound 0

struct MadeCase
{
    std::string output;
    ParticleCloud cloud;
    std::vector<float> densities;
};

/// Runs fppg on a case in a folder, which must go well.
inline MadeCase make(const TemporaryFolder& folder, const CaseText& text,
                     const Arguments& more = {})
{
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "out/Case"};
    words.insert(words.end(), more.begin(), more.end());
    const RunResult done = run(folder, words);
    EXPECT_EQ(done.code, 0) << done.output;
    return {done.output, read_particles(folder / "out/Case", false, 1),
            bi4_array<float>(read_text(folder / "out/Case.bi4"), "Rhop")};
}

} // namespace fppg::test
