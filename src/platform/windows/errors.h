#pragma once

#include <windows.h>

#include <string>

namespace fppg
{

/// Sets errno to what the last error of Windows comes nearest to.
void set_errno() noexcept;

/// What an error of Windows says.
std::string windows_text(DWORD error);

/// A name as Windows takes it. From 248 characters on it begins with \\?\, which lifts the limit of
/// 260 characters.
std::wstring wide(const std::string& path);

/// Text that is no name.
std::wstring wide_text(const std::string& text);
std::string utf8(const std::wstring& text);

} // namespace fppg
