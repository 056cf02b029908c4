#pragma once

#include "fppg/files.h"

#include "app/run_log.h"
#include "app/stopwatch.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// The files of a result while they are written: each has a temporary name until commit(), so that
/// an old result survives a run that fails.
class ResultFiles
{
public:
    /// A new file; the reference holds until the next one is made.
    OutputFile& add(const std::string& path)
    {
        return files_.emplace_back(are_written_ ? OutputFile(path) : OutputFile::not_written(path));
    }

    /// From here on files are not written: only their digests are made.
    void write_none() { are_written_ = false; }
    bool are_written() const { return are_written_; }

    /// Adds a file that is written already.
    void take(OutputFile file) { files_.push_back(std::move(file)); }

    /// Adds a file, lets body(file) write it, and tells how long it took.
    template <typename Body>
    void write(const std::string& path, const char* note, RunLog& log, const Body& body)
    {
        const Stopwatch time;
        OutputFile& file = add(path);
        body(file);
        const std::string digest = file.digest();
        log.text_line(fmt::format("{}{}{}{}  (time:{:.3f}s)", file.path(), note,
                                  are_written_ ? "" : "  not written, digest ", digest,
                                  time.seconds()));
        Json fact{{"path", file.path()}, {"seconds", time.seconds()}};
        if (!digest.empty()) fact["digest"] = digest;
        log.fact("file", fact);
    }

    /// Adds a copy of a file.
    ///
    /// throws  IoError if it cannot be read
    void copy(const std::string& source, const std::string& path);

    /// Whether a file of that name is among them.
    bool has(const std::string& path) const;

    /// Of all, in the order in which they were added.
    std::vector<std::string> names() const
    {
        std::vector<std::string> names;
        for (const OutputFile& file : files_) names.push_back(file.path());
        return names;
    }

    /// The last one is left out again.
    void drop_last() { files_.pop_back(); }

    /// None is left; nothing of them stays on the disk.
    void clear() { files_.clear(); }

    /// Gives all their names, Case.bi4 and Case.xml last and side by side; a stop is held off
    /// meanwhile. The old Case.xml goes before the new Case.bi4 comes. `three_vtk`: three copies of
    /// every .vtk, as GenCase makes them for its test runs. Where files are not written it does
    /// nothing.
    void commit(bool three_vtk);

private:
    std::vector<OutputFile> files_;
    bool are_written_ = true;

    void copy_pictures();
    void remove_old_xml() const;
};

} // namespace fppg
