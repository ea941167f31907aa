// Parameters at the ends of what numbers can hold: refused, or stepped with finite states in bounded time.
#include "extremes.h"

using namespace plab::test;

TEST_CASE("numeric fields alone at extremes: refused with a reason, or finite states within bounded work")
{
    constexpr std::size_t kOneOf = 16;  // all of them are in extremes_long_test.cpp
    std::size_t count = 0;
    for (const Subject& subject : subjects())
    {
        const std::vector<ExtremeCase> all = single_extremes(subject);
        std::vector<ExtremeCase> cases;
        for (std::size_t i = count % kOneOf; i < all.size(); i += kOneOf) cases.push_back(all[i]);
        count += all.size();
        for (const std::string& trouble : run_extremes(cases, 3)) FAIL_CHECK(trouble);
    }
    MESSAGE(count, " cases");
    CHECK((count > 16 * 100 || !tests_all_plugins()));
}
