#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// The bytes of a regular file for reading: mapped where the system can map it, read into memory
/// where it cannot (files of no stated size).
class FileMap
{
public:
    /// path    as the user named it
    /// throws  IoError that names the file and the cause
    explicit FileMap(const std::string& path);
    ~FileMap();
    FileMap(const FileMap&) = delete;
    FileMap& operator=(const FileMap&) = delete;

    /// Valid as long as the object lives.
    std::string_view bytes() const { return {data_, size_}; }

    /// Takes the pages that were read out of this program's memory; they are read again, mostly
    /// from the system's cache, when they are asked for. From any thread, at any time.
    void release() const;

private:
    const char* data_ = nullptr;
    std::size_t size_ = 0;
    void* mapping_ = nullptr;
    std::vector<char> buffer_;
};

/// Whether there is a file, no folder or device, of this name.
bool is_file(const std::string& path);

/// The bytes of a file; none where it cannot be read.
std::string read_whole(const std::string& path);

} // namespace fppg
