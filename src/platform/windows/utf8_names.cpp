// Names of files are UTF-8 in the program and wide in Windows. std::filesystem::path of GCC 12
// makes the one from the other by mbrtowc() of C, and Windows' C library has no UTF-8 for it: every
// byte becomes a letter. The program is linked with the libraries of C++ inside, which find this
// function before that of C.
#include <cerrno>
#include <cstddef>
#include <cwchar>

namespace
{

/// Length of a letter by its first byte; 0 where none begins so.
unsigned length_of(unsigned char first)
{
    if (first < 0x80) return 1;
    if (first < 0xC2) return 0;
    return first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
}

} // namespace

/// Of a letter beyond 16 bits the first call takes three bytes and gives the first half, the second
/// call, which `state` tells of, the fourth byte and the second half.
extern "C" std::size_t mbrtowc(wchar_t* out, const char* text, std::size_t n, std::mbstate_t* state)
{
    static std::mbstate_t own = {};
    if (state == nullptr) state = &own;
    if (text == nullptr) return 0;
    if (n == 0) return static_cast<std::size_t>(-2);
    if (*state != 0)
    {
        if (out != nullptr) *out = static_cast<wchar_t>(*state);
        *state = 0;
        return 1;
    }
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned length = length_of(byte(0));
    if (length > n) return static_cast<std::size_t>(-2);
    char32_t letter = length == 1 ? byte(0) : length == 0 ? 0 : byte(0) & (0x7FU >> length);
    bool is_valid = length > 0;
    for (unsigned i = 1; i < length; ++i)
    {
        is_valid = is_valid && (byte(i) & 0xC0U) == 0x80;
        letter = letter << 6 | (byte(i) & 0x3FU);
    }
    if (!is_valid)
    {
        errno = EILSEQ;
        return static_cast<std::size_t>(-1);
    }
    if (length == 4)
    {
        letter -= 0x10000;
        *state = static_cast<std::mbstate_t>(0xDC00 + (letter & 0x3FF));
        letter = 0xD800 + (letter >> 10);
    }
    if (out != nullptr) *out = static_cast<wchar_t>(letter);
    return letter == 0 ? 0 : length == 4 ? 3 : length;
}

extern "C" std::size_t mbrlen(const char* text, std::size_t n, std::mbstate_t* state)
{
    static std::mbstate_t own = {};
    return mbrtowc(nullptr, text, n, state != nullptr ? state : &own);
}

extern "C" std::size_t mbsrtowcs(wchar_t* out, const char** text, std::size_t n,
                                 std::mbstate_t* state)
{
    static std::mbstate_t own = {};
    if (state == nullptr) state = &own;
    const char* at = *text;
    for (std::size_t made = 0; out == nullptr || made < n; ++made)
    {
        const std::size_t taken = mbrtowc(out != nullptr ? out + made : nullptr, at, 4, state);
        if (taken == static_cast<std::size_t>(-2)) errno = EILSEQ;
        if (taken >= static_cast<std::size_t>(-2)) return static_cast<std::size_t>(-1);
        if (taken == 0)
        {
            if (out != nullptr) *text = nullptr;
            return made;
        }
        at += taken;
    }
    *text = at;
    return n;
}
