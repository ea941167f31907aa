/// The command line of plabctl: its options and commands, and how it is parsed. Only command_line.cpp includes CLI11, because
/// its headers take longer to compile than a command does.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "program/command_line.h"

namespace CLI
{
class App;
class Option;
}  // namespace CLI

namespace plab::cli
{

/// Properties of an option, set one after the other.
class Option
{
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option required() const;
    /// Placeholder for its value in the help.
    Option type_name(std::string_view name) const;
    /// `wrong_with` returns the error in a text; "": none.
    Option check(std::string (*wrong_with)(const std::string& text)) const;
    Option one_of(std::initializer_list<const char*> words) const;
    Option between(int least, int most) const;
    /// It may be given several times, with one value each.
    Option repeated() const;
    Option excludes(const Option& other) const;
    /// The help shows the initial value.
    Option show_default() const;

private:
    CLI::Option* option_;
};

class Command
{
public:
    explicit Command(CLI::App& app) : app_(&app) {}
    /// `name` with dashes is an option ("-o,--output"), otherwise a positional argument. T: std::string, a vector of it, a
    /// number, or an optional one. `value` must outlive parsing.
    template <class T>
    Option add_option(std::string_view name, T& value, std::string_view help) const;
    /// A sub-command of this one; global options may follow it. `footer` ends its help.
    Command add_command(const std::string& name, const std::string& doc, const std::string& footer, std::function<void()> chosen) const;
    void add_flag(std::string_view name, bool& value, std::string_view help) const;

private:
    CLI::App* app_;
};

/// What the help says beside the commands.
struct ProgramText
{
    std::string name, doc, version;
    std::string examples;         ///< first in its help
    std::string ending;           ///< last in its help, and in the man page
    std::string help_of_command;  ///< last in the help of each command
};

class CommandLine
{
public:
    explicit CommandLine(const ProgramText& text);
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;
    ~CommandLine();

    /// The program itself: add global options and commands to it.
    Command root() const { return Command(*app_); }
    /// Empty: the variables of the options are set, and the chosen command was called back.
    std::optional<program::ParseEnd> parse(int argc, const char* const* argv, const program::ValueSource& values) const;

private:
    ProgramText text_;
    std::unique_ptr<CLI::App> app_;
};

}  // namespace plab::cli
