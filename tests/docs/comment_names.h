/// What comments of the sources name, and the names that the code has.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "docs/named_things.h"

namespace plab::test
{

/// The text after `//` on one line.
struct Comment
{
    std::string text, file;
    int line = 0;
};

/// A C++ or IDL source, divided into what the compiler reads and what people read.
struct Source
{
    std::vector<Comment> comments;
    std::set<std::string> words;             ///< identifiers and keywords of the code, and the words of its string literals
    std::set<std::string> included_headers;  ///< as the source writes them
    std::set<std::string> types;             ///< classes, structs and enumerations that it declares
};

Source read_source(const std::string& text, const std::string& file);
/// Adds the words of any other text.
void add_words(const std::string& text, std::set<std::string>& words);

/// What comments may name.
struct Known
{
    Declared declared;
    std::set<std::string> words;  ///< of all code, scenes, scripts and build files, and the names of files without their ending
    std::set<std::string> included_headers;
    std::map<std::string, std::set<std::string>> members;  ///< of a type: the words of the files that declare it
};

/// The names in a comment that do not exist, each with the reason. Checked are:
/// - in backticks: what documents are checked for (named_things.h), and identifiers of the code;
/// - names of files with their ending, folders by their path from the root, and component types: `Kind/Name`;
/// - identifiers that cannot be English: with "::" or "()" or two capitals (ContactBook, kNothing), or of words of three letters or more
/// that
///   are joined or followed by underscores (run_blocks, swept_). Not in a line with an equation, where such names are symbols.
struct MissingName
{
    std::string name, reason;
};
std::vector<MissingName> missing_names(const Comment& comment, const Known& known);

/// Reads the working tree below `root`; all comments of its sources go to `comments`.
Known known_in(const std::string& root, std::vector<Comment>& comments);

}  // namespace plab::test
