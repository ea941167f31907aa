// What plabctl offers to shells: values from a running server.
#include <algorithm>
#include <chrono>

#include "plabctl.h"

using namespace plab::test;

namespace
{

/// The words of the candidates.
std::vector<std::string> complete(const std::string& line)
{
    const Outcome done = shell("", "--complete --domain " + std::to_string(test_domain()) + " --server lab " + line);
    CHECK(done.code == 0);
    CHECK(done.err.empty());
    std::vector<std::string> out;
    for (const std::string& l : done.lines()) out.push_back(l.substr(0, l.find('\t')));
    return out;
}

bool has_word(const std::vector<std::string>& words, const std::string& word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("ids, types of the family, fields and servers come from the server")
{
    FakeServer server(test_domain(), "lab");
    CHECK(complete("swap cont") == Words{"contact", "contact.response"});
    CHECK(complete("push ''") == Words{"a_fan_with_a_very_long_name", "red"});
    CHECK(complete("--server l") == Words{"lab"});
    const Words types = complete("swap contact.response --to ''");
    CHECK(!types.empty());
    for (const std::string& type : types) CHECK(type.starts_with("Response/"));
    CHECK(has_word(complete("types --family ''"), "Response"));
    CHECK(complete("set contact.resp") == Words{":nospace", "contact.response."});
    CHECK(has_word(complete("set contact.response."), "contact.response.restitution="));
    CHECK(has_word(complete("swap contact.response --to Impulse --param ''"), "restitution="));
    CHECK(has_word(complete("topics rate ''"), "plab/states"));
    CHECK(complete("info ''") == Words{":files"});
}

TEST_CASE("without an answer there are no candidates, quickly and silently")
{
    const auto start = std::chrono::steady_clock::now();
    CHECK(complete("swap ''").empty());
    CHECK(complete("plot no_such_file.mcap -q ''").empty());
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(3));
}
