#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// What a page shows of one result.
struct ResultLook
{
    std::string name;
    std::string note;    ///< below the picture, HTML
    std::string picture; ///< the bytes of a PNG; may be empty
    std::string set;     ///< its particles as to_json(SceneSet) writes them; may be empty
    std::string details; ///< counts, histograms, times and warnings, HTML; may be empty
};

/// Set and details as one JSON object, and back again; what is no such object gives an empty look.
std::string to_json(const ResultLook& look);
ResultLook read_look(const std::string& json);

/// Pictures side by side; a click shows the result in the 3-D view.
std::string pictures_html(const std::vector<ResultLook>& looks);

/// The 3-D view of all results: each by itself, or two side by side first.
std::string views_html(const std::vector<ResultLook>& looks);

/// The details of every result, to be opened; those of a single one are open.
std::string details_html(const std::vector<ResultLook>& looks);

} // namespace fppg
