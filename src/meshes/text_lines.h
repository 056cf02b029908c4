#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fppg
{

/// Words and numbers of a text file, with the line they stand on. Lines end with LF, CR LF or CR.
class TextLines
{
public:
    /// text  the part of the file that is read
    /// path  for messages
    TextLines(std::string_view text, const std::string& path) : text_(text), path_(&path) {}

    bool is_at_end() const { return at_ >= text_.size(); }
    std::size_t offset() const { return at_; }
    void seek(std::size_t offset) { at_ = offset; }
    /// Number of the line at the reading position, from 1; counts from the begin of the text.
    std::size_t line() const;

    /// The rest of the line without its end; goes to the next line.
    std::string_view next_line();

    /// The next word on any line; empty at the end of the text.
    std::string_view next_word();
    /// The next word on the same line; empty at its end. Does not leave the line.
    std::string_view next_word_of_line();
    /// As next_word, without going on.
    std::string_view peek_word();

    /// A number from the next word on any line; a number rounded to float32 as a binary file would
    /// hold it, where `is_float32`. "nan" and "inf" are read too.
    ///
    /// throws GeometryError "path:line: expected a number of ..., found '...'"
    double number(bool is_float32, const char* of_what);
    /// As number, on the same line.
    double number_of_line(bool is_float32, const char* of_what);
    std::uint64_t count(const char* of_what);
    std::int64_t integer(const char* of_what);
    std::int64_t integer_of_line(const char* of_what);

    /// throws GeometryError "path:line: text"
    [[noreturn]] void fail(const std::string& text) const;
    /// As fail, "expected ..., found 'word'"; at the end of the file it says so.
    [[noreturn]] void fail_at(std::string_view word, const std::string& expectation) const;

private:
    std::string_view text_;
    const std::string* path_;
    std::size_t at_ = 0;
};

/// A word shortened and without control characters, for messages.
std::string shown(std::string_view word);

} // namespace fppg
