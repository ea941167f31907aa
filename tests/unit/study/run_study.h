/// A whole study in this process.
#pragma once

#include "study/study.h"
#include "support/scene.h"

namespace plab::test
{

/// A study that fails is a failed test that shows why.
inline study::StudyResult study_of(const study::Plan& p)
{
    auto result = study::run_study(library(), p);
    REQUIRE_MESSAGE(result.ok(), (result ? "" : result.error().text()));
    return result.take();
}

}  // namespace plab::test
