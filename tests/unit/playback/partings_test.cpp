// What the server says is gone: believed after a moment, unless the server goes itself.
#include "recorder/partings.h"

#include <doctest/doctest.h>

#include "idl/recording/glance.h"

using namespace plab;
using recorder::Parting;
using recorder::Partings;

namespace
{

const Partings::Clock::time_point kStart{std::chrono::hours(1)};

std::string keys(const std::vector<Parting>& partings)
{
    std::string out;
    for (const Parting& p : partings) out += p.key + " ";
    return out;
}

Parting parting(const std::string& key) { return {"plab/objects", key, 1, 0, 0}; }

}  // namespace

TEST_CASE("a parting is believed when its doubt is over")
{
    Partings partings;
    partings.add(parting("a"), kStart);
    partings.add(parting("b"), kStart + std::chrono::milliseconds(10));
    CHECK(partings.take(kStart + Partings::kDoubt - std::chrono::milliseconds(1)).empty());
    CHECK(keys(partings.take(kStart + Partings::kDoubt)) == "a ");
    CHECK(keys(partings.take(kStart + std::chrono::hours(1))) == "b ");
    CHECK(partings.take(kStart + std::chrono::hours(1)).empty());
}

TEST_CASE("a thing that comes back was gone; what was heard before it stays in order, and a goodbye is forgotten")
{
    Partings partings;
    for (const char* key : {"a", "b", "c"}) partings.add(parting(key), kStart);
    CHECK(partings.take_before_return("plab/shapes", "b").empty());
    CHECK(keys(partings.take_before_return("plab/objects", "b")) == "a b ");
    CHECK(partings.take_before_return("plab/objects", "b").empty());
    partings.forget();
    CHECK(partings.take(kStart + std::chrono::hours(1)).empty());
}

TEST_CASE("the key of an instance that is gone is a text in either byte order; bytes that are none give nothing")
{
    const recording::Bytes little{0, 1, 0, 0, 4, 0, 0, 0, 'r', 'e', 'd', 0};
    const recording::Bytes big{0, 0, 0, 0, 0, 0, 0, 4, 'r', 'e', 'd', 0};
    CHECK(recording::key_of_gone(little) == "red");
    CHECK(recording::key_of_gone(big) == "red");
    for (std::size_t n = 0; n < little.size(); ++n) CHECK(recording::key_of_gone({little.data(), n}).empty());
    recording::Bytes endless = little;
    endless.back() = 'x';
    CHECK(recording::key_of_gone(endless).empty());
}
