#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CLI
{
class App;
class Option;
} // namespace CLI

namespace fppg
{

/// An option of a subcommand, to say more about it. Lives as long as its SubcommandLine.
class SubcommandOption
{
public:
    explicit SubcommandOption(CLI::Option* option) : option_(option) {}

    SubcommandOption& required();
    /// How many values follow; -1: any number.
    SubcommandOption& expected(int least, int most);
    /// It may be given several times, one value each, which are all kept.
    SubcommandOption& may_be_repeated();
    SubcommandOption& range(int least, int most);
    SubcommandOption& range(double least, double most);
    SubcommandOption& not_negative();
    SubcommandOption& positive();
    SubcommandOption& one_of(const std::vector<std::string>& words);
    SubcommandOption& needs(SubcommandOption other);
    SubcommandOption& excludes(SubcommandOption other);
    /// The help names the value that the variable has now.
    SubcommandOption& shows_default();

private:
    CLI::Option* option_;
};

/// The command line of a subcommand, read by CLI11. That header takes seconds to compile, so only
/// subcommand_line.cpp includes it.
class SubcommandLine
{
public:
    /// what  what the subcommand does, for the help; name  such as "fppg render"
    SubcommandLine(const std::string& what, const std::string& name);
    ~SubcommandLine();
    SubcommandLine(const SubcommandLine&) = delete;
    SubcommandLine& operator=(const SubcommandLine&) = delete;

    /// names  such as "-o,--output", or without a hyphen for what stands by its place
    /// value  where what was given goes; it must outlive read()
    SubcommandOption add_option(const std::string& names, std::string& value,
                                const std::string& what);
    SubcommandOption add_option(const std::string& names, std::vector<std::string>& value,
                                const std::string& what);
    SubcommandOption add_option(const std::string& names, int& value, const std::string& what);
    SubcommandOption add_option(const std::string& names, std::uint64_t& value,
                                const std::string& what);
    SubcommandOption add_option(const std::string& names, double& value, const std::string& what);
    /// An option without a value; giving it makes `value` true.
    SubcommandOption add_flag(const std::string& names, bool& value, const std::string& what);

    /// Reads the arguments. False if help was asked for: it is printed, and nothing is left to do.
    ///
    /// throws  UsageError that names the argument and how to get help
    bool read(const std::vector<std::string>& arguments);

private:
    std::unique_ptr<CLI::App> app_;
};

/// The variables of an option --evars, A=1:B=2, as -evars takes them.
///
/// throws  UsageError
std::vector<std::pair<std::string, std::string>> read_evars(const std::string& text);

} // namespace fppg
