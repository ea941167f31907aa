// No state of the process: libraries share nothing, and the order in which plugins are loaded does not matter.
#include <algorithm>
#include <set>

#include "subjects.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::unique_ptr<plugins::PluginLibrary> another_library() { return std::make_unique<plugins::PluginLibrary>(plugin_folders()); }

}  // namespace

TEST_CASE("two libraries have types, declarations and columns of their own")
{
    const auto other = another_library();
    CHECK(other->loaded().empty());
    CHECK(other->names() == library().names());
    for (const std::string& name : tested_types())
    {
        CAPTURE(name);
        const auto one = library().require(name), two = other->require(name);
        REQUIRE(one.ok());
        REQUIRE(two.ok());
        CHECK(*one != *two);
        CHECK((*one)->prototype != (*two)->prototype);
        CHECK((*one)->info.commands.size() == (*two)->info.commands.size());
        const std::vector<ColumnBase*> a = (*one)->schema.columns(), b = (*two)->schema.columns();
        REQUIRE(a.size() == b.size());
        const std::set<ColumnBase*> known(a.begin(), a.end());
        CHECK(std::none_of(b.begin(), b.end(), [&](ColumnBase* c) { return known.contains(c); }));
    }
}

TEST_CASE("a scene goes on alike when another library of the same plugins comes and goes")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const model::SceneSpec scene = compiled(subject.blueprint);
        const auto alone = started(scene);
        const std::vector<std::uint64_t> expected = hashes(*alone, 100);

        const auto lasting = started(scene);
        std::vector<std::uint64_t> seen = hashes(*lasting, 30);
        {
            const auto other = another_library();
            const auto passing = started(compiled(subject.blueprint, *other), 1, *other);
            hashes(*passing, 10);
            const std::vector<std::uint64_t> during = hashes(*lasting, 20);
            seen.insert(seen.end(), during.begin(), during.end());
        }
        const std::vector<std::uint64_t> after = hashes(*lasting, 50);
        seen.insert(seen.end(), after.begin(), after.end());
        CHECK(first_difference(seen, expected) == -1);
    }
}

TEST_CASE("the order in which plugins are loaded changes no bit")
{
    const auto backwards = another_library();
    std::vector<std::string> names = backwards->names();
    std::reverse(names.begin(), names.end());
    // Others' plugins may lack a library on this machine.
    for (const std::string& name : names) REQUIRE((backwards->require(name).ok() || !is_tested(name)));
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const auto one = started(compiled(subject.blueprint));
        const auto two = started(compiled(subject.blueprint, *backwards), 1, *backwards);
        CHECK(first_difference(hashes(*one, 100), hashes(*two, 100)) == -1);
    }
}
