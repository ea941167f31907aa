#include "control/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace plab::cli
{

Option Option::required() const { return Option(option_->required()); }
Option Option::type_name(std::string_view name) const { return Option(option_->type_name(std::string(name))); }
Option Option::check(std::string (*wrong_with)(const std::string& text)) const { return Option(option_->check(wrong_with, "")); }
Option Option::one_of(std::initializer_list<const char*> words) const
{
    return Option(option_->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end()))));
}
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

}  // namespace plab::cli
