// Neither the order of declarations, nor the number of threads, nor a neighbour in the process shows in the state.
#include <algorithm>

#include "subjects.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr int kOrderSteps = 100;

std::vector<std::uint64_t> hashes_of(const model::Blueprint& blueprint, int threads = 1)
{
    const auto running = started(compiled(blueprint), threads);
    return hashes(*running, kOrderSteps);
}

/// Fisher and Yates' shuffle with a generator of its own (SplitMix64's step): the same on every system.
template <class T>
void shuffle(std::vector<T>& items, std::uint64_t seed)
{
    for (std::size_t i = items.size(); i > 1; --i)
    {
        seed = seed * 6364136223846793005ull + 1442695040888963407ull;
        std::swap(items[i - 1], items[(seed >> 33) % i]);
    }
}

model::Blueprint scene_of(const Subject& subject) { return subject.repeatable() ? repeated(subject) : subject.blueprint; }

}  // namespace

TEST_CASE("the order in which components are declared changes no bit")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const std::vector<std::uint64_t> as_written = hashes_of(subject.blueprint);
        model::Blueprint reversed = subject.blueprint;
        std::reverse(reversed.components.begin(), reversed.components.end());
        CHECK(first_difference(hashes_of(reversed), as_written) == -1);
        for (std::uint64_t seed = 1; seed <= 3; ++seed)
        {
            CAPTURE(seed);
            model::Blueprint shuffled = subject.blueprint;
            shuffle(shuffled.components, seed);
            CHECK(first_difference(hashes_of(shuffled), as_written) == -1);
        }
    }
}

TEST_CASE("one, two and three threads give the same bits")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const model::Blueprint scene = scene_of(subject);
        const std::vector<std::uint64_t> one = hashes_of(scene);
        CHECK(first_difference(hashes_of(scene, 2), one) == -1);
        CHECK(first_difference(hashes_of(scene, 3), one) == -1);
    }
}

TEST_CASE("two worlds that take turns equal one alone")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const model::SceneSpec scene = compiled(subject.blueprint);
        const std::vector<std::uint64_t> alone = hashes_of(subject.blueprint);
        const auto a = started(scene), b = started(scene);
        b->step();
        b->step();
        std::vector<std::uint64_t> together;
        for (int i = 0; i < kOrderSteps; ++i)
        {
            together.push_back(hashes(*a, 1).front());
            b->step();
        }
        CHECK(first_difference(together, alone) == -1);
    }
}
