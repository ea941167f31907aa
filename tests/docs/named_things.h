/// What a document names in backticks, and whether it exists: files and folders, component types and commands, stages, tests.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace plab::test
{

/// The whole file; empty if it cannot be read.
std::string text_of_file(const std::string& path);

/// A piece of code within a sentence or a table; blocks of code are not searched.
struct NamedThing
{
    std::string text;      ///< without the backticks; a line break is a blank
    std::string document;  ///< path from the root of the repository
    int line = 0;          ///< where it begins
};

std::vector<NamedThing> named_things(const std::string& text, const std::string& document);

/// What a repository declares.
struct Declared
{
    std::set<std::string> paths;         ///< from the root; those of folders end with "/"
    std::string builds;                  ///< all CMakeLists.txt, one after the other
    std::string reference;               ///< server/docs/reference.md
    std::set<std::string> type_kinds;    ///< first words of component types: "Response"
    std::set<std::string> root_folders;  ///< "server", "tests"
};

/// Reads the working tree below `root`, without hidden folders and build folders.
Declared declared_in(const std::string& root);
/// `type_kinds` and `root_folders` from the other members.
void complete(Declared& declared);

/// Why what is named does not exist; "" if it exists or is of no kind that is checked. Names may have braces and asterisks:
/// `tests/unit/{link,control}`, `server/docs/*.md`.
std::string missing(const NamedThing& thing, const Declared& declared);

/// "--at" and "--revision" of `plabctl swap ID --at STEP --revision N`; none if the text is neither an option nor a command of a
/// program of pLab.
std::vector<std::string> options_in(const std::string& text);

/// "swap" of `plabctl swap gears`; "" if the text is no command of plabctl.
std::string plabctl_command_in(const std::string& text);

/// Whether `text` has `word` and no longer word that begins with it.
bool has_word(const std::string& text, const std::string& word);

}  // namespace plab::test
