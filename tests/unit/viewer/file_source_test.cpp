// States from a recording, each with the scene of its step.
#include "viewer/file_source.h"

#include <doctest/doctest.h>

#include "analysis/made_recording.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::unique_ptr<view::Source> open_source(const std::string& file, std::optional<double> from = {})
{
    auto source = view::FileSource::open(file, from);
    REQUIRE_MESSAGE(source.ok(), source.error().text());
    return source.take();
}

std::vector<view::Moment> all_of(view::Source& source)
{
    std::vector<view::Moment> out;
    while (auto moment = source.pop(link::Seconds(0))) out.push_back(std::move(*moment));
    return out;
}

const std::string& response_of(const view::Moment& moment) { return moment.scene->interactions.at("contact.response").type_name; }

}  // namespace

TEST_CASE("a recording gives all its states in order, and the algorithm in use")
{
    MadeOptions options;
    options.steps_after = 50;
    const auto source = open_source(make_recording("view_all.mcap", options));
    const auto moments = all_of(*source);
    REQUIRE(moments.size() == 201 + 51);
    for (std::size_t i = 0; i < moments.size(); ++i)
    {
        const view::State& state = moments[i].state;
        CHECK(state.run == (i <= 200 ? 1 : 2));
        CHECK(state.step == static_cast<std::int64_t>(i <= 200 ? i : i - 201));
        CHECK(response_of(moments[i]) == (state.run == 1 && state.step >= 100 ? "Response/None" : "Response/Impulse"));
        CHECK(moments[i].scene->scene->run == state.run);
        CHECK(moments[i].scene->objects.size() == 3);
    }
    REQUIRE(source->closed());
    CHECK(*source->closed() == "the recording ends at t = 0.500 s");
}

TEST_CASE("a time in the middle is found without reading what is before it, also if frames name only moved objects")
{
    for (const bool only_moved : {false, true})
    {
        MadeOptions options;
        options.steps = 1000, options.only_moved = only_moved;
        const auto source = open_source(make_recording(only_moved ? "view_thin.mcap" : "view_late.mcap", options), 8.0);
        const auto moments = all_of(*source);
        REQUIRE(!moments.empty());
        CHECK(moments.size() == (only_moved ? 351 : 201));
        CHECK(moments.front().state.time <= 8.0);
        CHECK(response_of(moments.front()) == "Response/None");
        const auto at = std::find_if(moments.begin(), moments.end(), [](const view::Moment& m) { return m.state.step == 805; });
        REQUIRE(at != moments.end());
        REQUIRE(at->state.bodies.size() == 2);
        const double reported = only_moved ? 8.0 : 8.05;  // of blue
        CHECK(at->state.bodies[1].pose.p.z == doctest::Approx(reported * reported));
    }
}

TEST_CASE("a time that only a later run reaches is found there; a file without objects is refused")
{
    MadeOptions options;
    options.steps = 50, options.steps_after = 100;
    const auto moments = all_of(*open_source(make_recording("view_runs.mcap", options), 0.9));
    REQUIRE(!moments.empty());
    CHECK(moments.back().state.run == 2);
    CHECK(moments.back().state.time == doctest::Approx(1.0));
    CHECK(std::any_of(moments.begin(), moments.end(), [](const view::Moment& m) { return m.state.run == 2 && m.state.step == 90; }));
    options.with_catalogue = false;
    CHECK_FALSE(view::FileSource::open(make_recording("view_bare.mcap", options), {}).ok());
    CHECK_FALSE(view::FileSource::open(fresh_path("view_none.mcap"), {}).ok());
}
