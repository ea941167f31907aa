#include "control/command/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <sstream>
#include <utility>
#include <vector>

#include "control/console/console.h"
#include "link/names.h"

namespace plab::cli
{
namespace
{

/// Help with the examples first: most readers need no more.
class Format : public CLI::Formatter
{
public:
    explicit Format(const ProgramText& text) : text_(text) {}
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override
    {
        if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
        std::ostringstream out;
        out << make_description(app) << '\n'
            << make_usage(app, name) << app->get_footer() << make_positionals(app) << make_groups(app, mode);
        out << make_subcommands(app, mode);
        out << (app->get_parent() != nullptr ? text_.help_of_command : text_.ending);
        return out.str();
    }

private:
    ProgramText text_;
};

/// What CLI11 says, and which command or option was probably meant.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error)
{
    const std::vector<std::string> rest = app.remaining();
    if (rest.empty() || dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return error.what();
    std::vector<std::string> known;
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const bool is_option = rest.front().starts_with("-");
    if (is_option)
    {
        for (const CLI::App* a : {&app, chosen.empty() ? &app : static_cast<const CLI::App*>(chosen.front())})
            for (const CLI::Option* option : a->get_options())
                for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
    else if (chosen.empty())
        for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) known.push_back(command->get_name());
    const std::string what = is_option ? "no option '" : chosen.empty() ? "no command '" : "too many arguments: '";
    return what + rest.front() + "'" + link::did_you_mean(rest.front(), known);
}

}  // namespace

Option Option::required() const { return Option(option_->required()); }
Option Option::type_name(std::string_view name) const { return Option(option_->type_name(std::string(name))); }
Option Option::check(std::string (*wrong_with)(const std::string& text)) const { return Option(option_->check(wrong_with, "")); }
Option Option::one_of(std::initializer_list<const char*> words) const
{
    return Option(option_->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end()))));
}
Option Option::between(int least, int most) const { return Option(option_->check(CLI::Range(least, most))); }
Option Option::repeated() const { return Option(option_->take_all()->allow_extra_args(false)); }
Option Option::excludes(const Option& other) const { return Option(option_->excludes(other.option_)); }
Option Option::show_default() const { return Option(option_->capture_default_str()); }

template <class T>
Option Command::add_option(std::string_view name, T& value, std::string_view help) const
{
    return Option(app_->add_option(std::string(name), value, std::string(help)));
}
template Option Command::add_option(std::string_view, std::string&, std::string_view) const;
template Option Command::add_option(std::string_view, std::optional<std::string>&, std::string_view) const;
template Option Command::add_option(std::string_view, std::vector<std::string>&, std::string_view) const;
template Option Command::add_option(std::string_view, double&, std::string_view) const;
template Option Command::add_option(std::string_view, std::optional<double>&, std::string_view) const;
template Option Command::add_option(std::string_view, std::uint32_t&, std::string_view) const;
template Option Command::add_option(std::string_view, std::int64_t&, std::string_view) const;
template Option Command::add_option(std::string_view, std::optional<std::int64_t>&, std::string_view) const;
template Option Command::add_option(std::string_view, std::optional<std::uint64_t>&, std::string_view) const;

Command Command::add_command(const std::string& name, const std::string& doc, const std::string& footer, std::function<void()> chosen) const
{
    CLI::App* const command = app_->add_subcommand(name, doc);
    command->fallthrough()->footer(footer)->callback(std::move(chosen));
    return Command(*command);
}

void Command::add_flag(std::string_view name, bool& value, std::string_view help) const
{
    app_->add_flag(std::string(name), value, std::string(help));
}

CommandLine::CommandLine(const ProgramText& text) : text_(text), app_(std::make_unique<CLI::App>(text.doc, text.name))
{
    app_->formatter(std::make_shared<Format>(text));
    app_->footer(text.examples);
    app_->require_subcommand(0, 1);
    app_->set_version_flag("--version", text.name + " " + text.version);
}

CommandLine::~CommandLine() = default;

std::optional<program::ParseEnd> CommandLine::parse(int argc, const char* const* argv, const program::ValueSource& values) const
{
    if (auto answer = program::answer_for_shell(*app_, argc, argv, text_.version, values, text_.ending))
        return program::ParseEnd{0, *answer};
    try
    {
        app_->parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        constexpr int kUsage = 2;
        if (error.get_exit_code() != 0)
            return program::ParseEnd{kUsage,
                                     text_.name + ": " + printable(usage_message(*app_, error)) + "; see " + text_.name + " --help\n"};
        std::ostringstream out;
        (void)app_->exit(error, out, out);
        return program::ParseEnd{0, out.str()};
    }
    return {};
}

}  // namespace plab::cli
