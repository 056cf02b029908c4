#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fppg
{

// Files by descriptors. Names are UTF-8. What fails leaves its cause in errno, as standard
// functions do.

/// Makes a file for writing; fails with EEXIST where there is one of this name.
///
/// returns  its descriptor, or -1
int make_file(const std::string& path);

/// Opens a file for a lock and for the name of its owner; makes it where there is none.
///
/// returns  its descriptor, or -1
int open_lock_file(const std::string& path);

/// Gives a file its length and its place on the disk, so that a full disk is noticed before the
/// work. Where the file system cannot reserve, only the length is set.
bool reserve_file(int file, std::uint64_t bytes);

/// returns  the bytes that were written, or -1
std::int64_t write_file_at(int file, std::uint64_t offset, const void* data, std::size_t bytes);

/// Some file systems report a failed write only here.
bool close_file(int file);

/// Gives a file another name, in place of whatever file has it: as one step.
bool replace_file(const std::string& from, const std::string& to);

/// May be called while a signal is handled.
bool remove_file(const char* path) noexcept;

/// Whether errno says that there is no room left for files.
bool is_disk_full(int error);

/// Takes the lock of a file, which the system gives back with the descriptor. Does not wait: where
/// another process has it, errno is EWOULDBLOCK.
bool lock_file(int file, bool is_shared);

/// Empties a file that is locked and writes `text` into it, which others may read meanwhile.
bool write_locked_file(int file, const std::string& text);

/// The first line of a file that another process may have locked; empty where it cannot be read.
std::string first_line_of_locked_file(const std::string& path);

/// Whether the file of a descriptor still has this name.
bool has_name(int file, const std::string& path);

/// Whether another process has the lock of a file, or that cannot be found out.
bool is_locked(const std::string& path);

/// What ends the name of a folder in a path.
std::string_view folder_ends();

/// Text as files for editors hold it on this system: lines of Windows end with CR and LF.
std::string with_line_ends(std::string text);

/// Makes a folder that only this user may enter, for files that are no result.
///
/// throws  IoError
std::string make_scratch_folder();

} // namespace fppg
