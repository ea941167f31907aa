/// Completion of command lines: what may stand at the cursor, as the program's own parser has it. Shells ask the program, so that there is
/// no second list of options to keep.
///
///   plabctl --print bash                      a few lines for the shell, which call the next
///   plabctl --complete swap gears --to Con    a line for each candidate: the word, a tab, what it is
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/command_outline.h"

namespace plab::program
{

struct Candidate
{
    std::string word, help;
};

/// What is asked for at the cursor, and what stands before it.
struct Wanted
{
    std::vector<Candidate> candidates;                      ///< options, commands, words out of a list
    std::string value;                                      ///< what a value is called there: "ID"; "": none is wanted
    std::string option;                                     ///< whose value: "--to", or the name of a place, "id"
    std::string command;                                    ///< "swap"; "": none yet
    std::string begun;                                      ///< what is typed of the value
    std::string before;                                     ///< what stands before it in the same word: "--to="
    std::map<std::string, std::vector<std::string>> given;  ///< values that stand there already, by the option's last name or place

    /// The first value given; "" if there is none.
    std::string first(const std::string& name) const;
};

/// `words`: those behind the program's name, up to the cursor; the last is begun, perhaps empty.
Wanted wanted_at(const CommandOutline& program, const std::vector<std::string>& words);

/// Values that only the program knows: ids, types. None for what it does not know; it takes a second at most.
struct Values
{
    std::vector<Candidate> candidates;
    bool are_files = false;  ///< names of files are candidates as well
    bool go_on = false;      ///< more of the same word follows: "gears." is not yet all
};
using ValueSource = std::function<Values(const Wanted&)>;

/// What --complete prints.
std::string completion_lines(const CommandOutline& program, const std::vector<std::string>& words, const ValueSource& values);
/// For "bash", "zsh" or "fish"; "": no such shell.
std::string completion_script(const std::string& program, const std::string& shell);

/// What the hidden first words --print (man, bash, zsh, fish) and --complete ask for; nothing: an ordinary command line.
std::optional<std::string> answer_for_shell(const CommandOutline& program, int argc, const char* const* argv, const std::string& version,
                                            const ValueSource& values = {}, const std::string& more = {});

}  // namespace plab::program
