#pragma once

#include <stdexcept>
#include <string>

namespace fppg
{

/// What went wrong, and whose problem it is. The program catches these in one place (main) and
/// turns each into a message and an exit code.
class Error : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    /// The exit code of the program: 2 usage, 3 case or geometry, 4 file, 5 a fault of our own.
    virtual int exit_code() const { return 5; }
};

/// A wrong command line.
class UsageError : public Error
{
public:
    using Error::Error;
    int exit_code() const override { return 2; }
};

/// The case definition is wrong. The text names file, line and element, and what was expected.
class CaseError : public Error
{
public:
    /// file  the XML as the user named it; line from 1, or 0 when the error has no line
    /// text  what is wrong, what was expected
    CaseError(const std::string& file, int line, const std::string& text);
    using Error::Error;
    int exit_code() const override { return 3; }
};

/// A mesh cannot be used for what the case asks of it. The text names the file.
class GeometryError : public Error
{
public:
    using Error::Error;
    int exit_code() const override { return 3; }
};

/// Of a combination of parts nothing is left.
class NothingLeft : public GeometryError
{
public:
    using GeometryError::GeometryError;
};

/// A file cannot be read or written. The text names the file and the cause.
class IoError : public Error
{
public:
    using Error::Error;
    int exit_code() const override { return 4; }
};

/// A signal asked to stop, SIGINT where it is Ctrl-C; outputs of before are untouched.
class Interrupted : public Error
{
public:
    explicit Interrupted(int signal)
        : Error("stopped by the user; no output file was changed"), signal_(signal)
    {
    }
    int exit_code() const override { return 128 + signal_; }

private:
    int signal_;
};

} // namespace fppg
