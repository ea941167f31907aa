// Extremes over more steps, and in pairs. One type alone: --subcase="Constraint/Distance".
#include "extremes.h"

using namespace plab::test;

TEST_CASE("every numeric field alone at extremes, for 60 steps")
{
    for (const Subject& subject : subjects()) SUBCASE(subject.type.c_str())
    for (const std::string& trouble : run_extremes(single_extremes(subject), 60)) FAIL_CHECK(trouble);
}

TEST_CASE("every pair of numeric fields at extremes")
{
    for (const Subject& subject : subjects()) SUBCASE(subject.type.c_str())
        {
            const auto cases = paired_extremes(subject);
            MESSAGE(subject.type, ": ", cases.size());
            for (const std::string& trouble : run_extremes(cases, 3)) FAIL_CHECK(trouble);
        }
}
