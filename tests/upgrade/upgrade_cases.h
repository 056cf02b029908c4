#pragma once

#include "upgrade/upgrade.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace fppg::test
{

/// A definition with these parts, which is no case that could run.
inline std::string definition(const std::string& in_casedef, const std::string& in_execution = "")
{
    return "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<case>\n    <casedef>\n" + in_casedef +
           "    </casedef>\n    <execution>\n" + in_execution + "    </execution>\n</case>\n";
}

/// The upgrade, which must have nothing to do a second time.
inline UpgradedDefinition upgrade(const std::string& text)
{
    UpgradedDefinition out = upgrade_definition(text, "CaseA_Def.xml");
    const UpgradedDefinition again = upgrade_definition(out.text, "CaseA_Def.xml");
    EXPECT_TRUE(again.changes.empty()) << again.changes.front().from;
    EXPECT_EQ(again.text, out.text);
    return out;
}

inline void expect_upgrade(const std::string& before, const std::string& after)
{
    EXPECT_EQ(upgrade(before).text, after);
}

/// Nothing changes, and a note says why.
inline void expect_note(const std::string& text, int line, const std::string& part)
{
    const UpgradedDefinition out = upgrade(text);
    EXPECT_EQ(out.text, text);
    ASSERT_EQ(out.notes.size(), 1U);
    EXPECT_EQ(out.notes[0].line, line);
    EXPECT_NE(out.notes[0].text.find(part), std::string::npos) << out.notes[0].text;
}

} // namespace fppg::test
