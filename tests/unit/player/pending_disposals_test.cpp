// Disposals of instances: accepted after a moment, unless the server itself is ending.
#include "control/recording/recorder/pending_disposals.h"

#include <doctest/doctest.h>

#include "idl/recording/sample_header.h"

using namespace plab;
using recorder::Disposal;
using recorder::PendingDisposals;

namespace
{

const PendingDisposals::Clock::time_point kFirstDisposal{std::chrono::hours(1)};

std::string keys(const std::vector<Disposal>& disposals)
{
    std::string out;
    for (const Disposal& p : disposals) out += p.key + " ";
    return out;
}

Disposal disposal(const std::string& key) { return {"plab/objects", key, 1, 0, 0}; }

}  // namespace

TEST_CASE("a disposal is accepted when its waiting time is over")
{
    PendingDisposals disposals;
    disposals.add(disposal("a"), kFirstDisposal);
    disposals.add(disposal("b"), kFirstDisposal + std::chrono::milliseconds(10));
    CHECK(disposals.take(kFirstDisposal + PendingDisposals::kDoubt - std::chrono::milliseconds(1)).empty());
    CHECK(keys(disposals.take(kFirstDisposal + PendingDisposals::kDoubt)) == "a ");
    CHECK(keys(disposals.take(kFirstDisposal + std::chrono::hours(1))) == "b ");
    CHECK(disposals.take(kFirstDisposal + std::chrono::hours(1)).empty());
}

TEST_CASE(
    "an instance that comes back had been disposed of; earlier disposals stay in order, and the end of the server cancels pending ones")
{
    PendingDisposals disposals;
    for (const char* key : {"a", "b", "c"}) disposals.add(disposal(key), kFirstDisposal);
    CHECK(disposals.take_before_return("plab/shapes", "b").empty());
    CHECK(keys(disposals.take_before_return("plab/objects", "b")) == "a b ");
    CHECK(disposals.take_before_return("plab/objects", "b").empty());
    disposals.forget();
    CHECK(disposals.take(kFirstDisposal + std::chrono::hours(1)).empty());
}

TEST_CASE("the key of a disposed instance is read as text in either byte order; invalid bytes give nothing")
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
