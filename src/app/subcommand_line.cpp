#include "app/subcommand_line.h"

#include "core/finite_number.h"
#include "core/nearest_word.h"
#include "fppg/error.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <functional>
#include <optional>

namespace fppg
{

namespace
{

/// A check of a number, which the help words as "(0 to 10)" behind what the option does.
void check_number(CLI::Option& option, const std::function<bool(double)>& holds,
                  const std::string& words)
{
    const auto fault = [holds, words](const std::string& text)
    {
        const std::optional<double> number = finite_number(text);
        return number && holds(*number)
                   ? std::string()
                   : fmt::format("\"{}\" is invalid, expected {}", text, words);
    };
    option.check(CLI::Validator(fault, ""));
    option.description(fmt::format("{} ({})", option.get_description(), words));
}

/// Help in words: `--threads N  ... (0 to 4096, default 0)`.
class HelpText : public CLI::Formatter
{
    std::string make_option_usage(const CLI::Option* option) const override
    {
        const bool is_list = option->get_expected_max() > 1;
        const std::string name = option->get_name(true) + (is_list ? "..." : "");
        return option->get_required() ? name : "[" + name + "]";
    }

    std::string make_option_opts(const CLI::Option* option) const override
    {
        if (option->get_positional() || option->get_expected_max() == 0) return "";
        const std::string type = option->get_type_name();
        return type == "FLOAT" ? " NUMBER" : type == "INT" || type == "UINT" ? " N" : " TEXT";
    }

    std::string make_option_desc(const CLI::Option* option) const override
    {
        const std::string standard = option->get_default_str();
        return option->get_description() +
               (standard.empty() ? "" : fmt::format(" (default {})", standard));
    }
};

} // namespace

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
    check_number(
        *option_, [=](double n) { return n >= least && n <= most; },
        fmt::format("{} to {}", least, most));
    return *this;
}

SubcommandOption& SubcommandOption::range(double least, double most)
{
    check_number(
        *option_, [=](double n) { return n >= least && n <= most; },
        fmt::format("{:g} to {:g}", least, most));
    return *this;
}

SubcommandOption& SubcommandOption::not_negative()
{
    check_number(
        *option_, [](double n) { return n >= 0; }, "0 or more");
    return *this;
}

SubcommandOption& SubcommandOption::positive()
{
    check_number(
        *option_, [](double n) { return n > 0; }, "above 0");
    return *this;
}

SubcommandOption& SubcommandOption::one_of(const std::vector<std::string>& words)
{
    option_->check(CLI::IsMember(words).description(""));
    option_->description(
        fmt::format("{} ({})", option_->get_description(), fmt::join(words, " or ")));
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
    app_->formatter(std::make_shared<HelpText>());
    app_->get_formatter()->label("OPTIONS", "options");
    app_->get_formatter()->label("Positionals", "Arguments");
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

namespace
{

/// Options may be written as in a run: -dp:0.01 for --dp=0.01, -threads:2, -strict.
std::string in_long_form(const CLI::App& app, const std::string& argument)
{
    if (!argument.starts_with('-') || argument.starts_with("--")) return argument;
    const std::size_t colon = argument.find(':');
    const std::string name = argument.substr(1, colon == std::string::npos ? colon : colon - 1);
    for (const CLI::Option* option : app.get_options())
        for (const std::string& known : option->get_lnames())
            if (name == known)
                return colon == std::string::npos
                           ? "--" + name
                           : fmt::format("--{}={}", name, argument.substr(colon + 1));
    return argument;
}

} // namespace

bool SubcommandLine::read(const std::vector<std::string>& arguments)
{
    std::vector<std::string> words; // the last first, as CLI11 wants them
    for (auto word = arguments.rbegin(); word != arguments.rend(); ++word)
        words.push_back(in_long_form(*app_, *word));
    try
    {
        app_->parse(words);
    }
    catch (const CLI::CallForHelp&)
    {
        fmt::print("{}", app_->help());
        return false;
    }
    catch (const CLI::ExtrasError& error)
    {
        std::vector<std::string> known;
        for (const CLI::Option* option : app_->get_options())
            for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
        const std::vector<std::string_view> views(known.begin(), known.end());
        std::string hint;
        for (const std::string& extra : app_->remaining())
            if (hint.empty() && extra.starts_with('-'))
                hint = did_you_mean(extra.substr(0, extra.find_first_of("=:")), views);
        throw UsageError(
            fmt::format("{}{}; {} --help shows the form", error.what(), hint, app_->get_name()));
    }
    catch (const CLI::ParseError& error)
    {
        throw UsageError(
            fmt::format("{}; {} --help shows the form", error.what(), app_->get_name()));
    }
    return true;
}

std::vector<std::pair<std::string, std::string>> read_evars(const std::string& text)
{
    std::vector<std::pair<std::string, std::string>> out;
    for (std::size_t begin = 0; begin < text.size();)
    {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        const std::string one = text.substr(begin, end - begin);
        const std::size_t equals = one.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError(
                fmt::format("--evars: \"{}\" is invalid, expected NAME=VALUE, several of them "
                            "with colons between",
                            text));
        out.emplace_back(one.substr(0, equals), one.substr(equals + 1));
        begin = end + 1;
    }
    return out;
}

} // namespace fppg
