// What comments of the sources name exists: files, component types, stages, tests, and identifiers of the code. named_things.h and
// comment_names.h state what counts as a name.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "docs/comment_names.h"

namespace plab::test
{
namespace
{

/// Names that look like ours and are not. A name that no comment uses any more fails the test, so that the list stays short.
struct ForeignName
{
    std::string_view text, why;
};
constexpr ForeignName kForeignNames[] = {
    {"AddressSanitizer", "a tool of compilers"},
    {"Quaterniond", "a type of Eigen"},
    {"SimBenchmark", "a collection of benchmark problems"},
    {"SplitMix64", "a generator of random numbers"},
    {"TypeObject", "a term of XTypes"},
    {"TypeObjects", "a term of XTypes"},
    {"a.xml", "an example"},
    {"add_pause_command", "an example"},
    {"log_times", "a field of MCAP"},
    {"math.h", "a header of C"},
    {"quickN", "a placeholder"},
    {"run_pause", "an example"},
    {"siN", "a placeholder"},
    {"very_", "an example"},
    {"very_long_name", "an example"},
};

std::vector<std::string> complaints_about(const std::string& source, const Known& known)
{
    std::vector<std::string> out;
    for (const Comment& comment : read_source(source, "server/step/made_up.h").comments)
        for (const MissingName& m : missing_names(comment, known)) out.push_back(std::to_string(comment.line) + ": " + m.reason);
    return out;
}

Known made_up_names()
{
    Known out;
    out.declared.paths = {"server/", "server/step/", "server/step/tree.h", "tests/", "tests/swaps_test.cpp"};
    out.declared.reference = "# Types\n\n## Response\n\n### Response/None\n\n- exchangeable within: `Response`\n";
    complete(out.declared);
    add_words("class ContactBook { void run_blocks(); };", out.words);
    out.members = {{"ContactBook", {"run_blocks"}}}, out.words.insert("swaps");
    out.included_headers = {"expat.h"};
    return out;
}

}  // namespace

TEST_CASE("comments are told from code, strings and raw strings")
{
    const Source source = read_source(
        "#include <expat.h>\n"
        "int a = 'x'; // one\n"
        "auto b = \"// no\\\" // no\"; /// two\n"
        "auto c = R\"x(\n// no )\" // no\n)x\"; // three\n",
        "a.cpp");
    std::vector<std::string> texts;
    for (const Comment& comment : source.comments) texts.push_back(std::to_string(comment.line) + comment.text);
    CHECK(texts == std::vector<std::string>{"2 one", "3/ two", "6 three"});
    CHECK(source.words.contains("b"));
    CHECK_FALSE(source.words.contains("two"));
    CHECK(source.included_headers == std::set<std::string>{"expat.h"});
}

TEST_CASE("a comment that names what does not exist is found out")
{
    const Known known = made_up_names();
    CHECK(complaints_about("// tree.h, (step/tree.h), <expat.h>: Response/None, ContactBook::run_blocks(), `run_blocks`, `Stage/Step`,\n"
                           "// `tests/swaps_test.cpp`. N m/s, p_WB, x_i, and/or, SI; alpha_root = speed_root; e.g. `2 * x`\n",
                           known)
              .empty());
    const auto only = [&](const char* text) { return complaints_about(text, known); };
    CHECK(only("\n// see bush.h\n") == std::vector<std::string>{"2: no file or folder is called bush.h"});
    CHECK(only("// (step/bush.h)") == std::vector<std::string>{"1: no file or folder is called step/bush.h"});
    CHECK(only("// in tests/walk)") == std::vector<std::string>{"1: no file or folder is called tests/walk"});
    CHECK(only("// `server/walk`") == std::vector<std::string>{"1: no file or folder is called server/walk"});
    CHECK(only("// of Response/Some.") == std::vector<std::string>{"1: no type, family or command is called Response/Some"});
    CHECK(only("// `Stage/Stop`") == std::vector<std::string>{"1: no stage is called Stage/Stop"});
    CHECK(only("/// `run_blockz`") == std::vector<std::string>{"1: no code has the name run_blockz"});
    CHECK(only("/// calls run_blockz") == std::vector<std::string>{"1: no code has the name run_blockz"});
    CHECK(only("/// calls runs()") == std::vector<std::string>{"1: no code has the name runs"});
    CHECK(only("/// a ContactBuk") == std::vector<std::string>{"1: no code has the name ContactBuk"});
    CHECK(only("/// ContactBook::walk") == std::vector<std::string>{"1: no code has the name walk"});
    CHECK(only("/// ContactBook::swaps()") == std::vector<std::string>{"1: ContactBook has no swaps"});
}

TEST_CASE("files, types, stages, tests and identifiers that comments name exist")
{
    std::vector<Comment> comments;
    const Known known = known_in(PLAB_SOURCE_DIR, comments);
    CHECK(comments.size() > 10000);
    std::set<const ForeignName*> used;
    for (const Comment& comment : comments)
        for (const MissingName& m : missing_names(comment, known))
        {
            const auto foreign = std::find_if(std::begin(kForeignNames), std::end(kForeignNames),
                                              [&](const ForeignName& f) {
                                                  return (m.name == f.text || m.name.ends_with("/" + std::string(f.text)) ||
                                                          m.name.ends_with("::" + std::string(f.text)));
                                              });
            if (foreign != std::end(kForeignNames))
                used.insert(foreign);
            else
                FAIL_CHECK(comment.file << ":" << comment.line << ": " << m.name << ": " << m.reason);
        }
    for (const ForeignName& f : kForeignNames) CHECK_MESSAGE(used.contains(&f), "no comment names " << f.text << " any more");
}

}  // namespace plab::test
