/// A sink that keeps all events.
#pragma once

#include <vector>

#include "plab/context.h"

namespace plab::test
{

struct Events final : EventSink
{
    std::vector<Event> all;
    void emit(Event event) override { all.push_back(std::move(event)); }
};

}  // namespace plab::test
