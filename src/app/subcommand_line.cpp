#include "app/subcommand_line.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace fppg
{

SubcommandOption& SubcommandOption::required()
{
    option_->required();
    return *this;
}

SubcommandOption& SubcommandOption::expected(int least, int most)
{
    option_->expected(least, most);
    return *this;
}

SubcommandOption& SubcommandOption::may_be_repeated()
{
    option_->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return *this;
}

SubcommandOption& SubcommandOption::range(int least, int most)
{
    option_->check(CLI::Range(least, most));
    return *this;
}

SubcommandOption& SubcommandOption::range(double least, double most)
{
    option_->check(CLI::Range(least, most));
    return *this;
}

SubcommandOption& SubcommandOption::not_negative()
{
    option_->check(CLI::NonNegativeNumber);
    return *this;
}

SubcommandOption& SubcommandOption::positive()
{
    option_->check(CLI::PositiveNumber);
    return *this;
}

SubcommandOption& SubcommandOption::one_of(const std::vector<std::string>& words)
{
    option_->check(CLI::IsMember(words));
    return *this;
}

SubcommandOption& SubcommandOption::needs(SubcommandOption other)
{
    option_->needs(other.option_);
    return *this;
}

SubcommandOption& SubcommandOption::excludes(SubcommandOption other)
{
    option_->excludes(other.option_);
    return *this;
}

SubcommandOption& SubcommandOption::shows_default()
{
    option_->capture_default_str();
    return *this;
}

SubcommandLine::SubcommandLine(const std::string& what, const std::string& name)
    : app_(std::make_unique<CLI::App>(what, name))
{
}

SubcommandLine::~SubcommandLine() = default;

SubcommandOption SubcommandLine::add_option(const std::string& names, std::string& value,
                                            const std::string& what)
{
    return SubcommandOption(app_->add_option(names, value, what));
}

SubcommandOption SubcommandLine::add_option(const std::string& names,
                                            std::vector<std::string>& value,
                                            const std::string& what)
{
    return SubcommandOption(app_->add_option(names, value, what));
}

SubcommandOption SubcommandLine::add_option(const std::string& names, int& value,
                                            const std::string& what)
{
    return SubcommandOption(app_->add_option(names, value, what));
}

SubcommandOption SubcommandLine::add_option(const std::string& names, std::uint64_t& value,
                                            const std::string& what)
{
    return SubcommandOption(app_->add_option(names, value, what));
}

SubcommandOption SubcommandLine::add_option(const std::string& names, double& value,
                                            const std::string& what)
{
    return SubcommandOption(app_->add_option(names, value, what));
}

SubcommandOption SubcommandLine::add_flag(const std::string& names, bool& value,
                                          const std::string& what)
{
    return SubcommandOption(app_->add_flag(names, value, what));
}

bool SubcommandLine::read(const std::vector<std::string>& arguments)
{
    try
    {
        app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    }
    catch (const CLI::CallForHelp&)
    {
        fmt::print("{}", app_->help());
        return false;
    }
    catch (const CLI::ParseError& error)
    {
        throw UsageError(
            fmt::format("{}; {} --help shows the form", error.what(), app_->get_name()));
    }
    return true;
}

} // namespace fppg
