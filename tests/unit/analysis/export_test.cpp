// Recordings as tables and as JSON: the numbers are those that were recorded, to the last bit.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "control/recording/analysis/export.h"
#include "control/recording/analysis/tables.h"
#include "made_recording.h"
#include "support/text.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;
using Json = nlohmann::ordered_json;

namespace
{

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

std::vector<std::string> cells_of(const std::string& line)
{
    std::vector<std::string> out;
    std::istringstream in(line + ",");
    for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
    return out;
}

std::string exported(const std::string& file, ExportOptions options, bool csv = true)
{
    auto log = Log::open(file);
    REQUIRE(log.ok());
    options.out = fresh_path("export.out");
    const auto done = csv ? export_csv(*log, options) : export_json(*log, options);
    REQUIRE_MESSAGE(done.ok(), done.error().text());
    CHECK(done->troubles.count == 0);
    return content_of(options.out);
}

std::string refused_export(const std::string& file, const ExportOptions& options)
{
    auto log = Log::open(file);
    REQUIRE(log.ok());
    const auto done = export_csv(*log, options);
    REQUIRE(!done.ok());
    return done.error().text();
}

}  // namespace

TEST_CASE("states: one row per object and frame, in full precision")
{
    const std::vector<std::string> lines = lines_of(exported(make_recording("export_states.mcap"), {}));
    REQUIRE(lines.size() == 1 + 201 * 3);
    const std::vector<std::string> head = cells_of(lines[0]);
    CHECK(lines[0].starts_with("run,step,time_s,log_time_s,object,kind,position_x_m,position_y_m,"));
    const std::vector<std::string> red = cells_of(lines[1 + 57 * 3]);
    REQUIRE(red.size() == head.size());
    CHECK(red[1] == "57");
    CHECK(std::stod(red[2]) == 57 * kMadeStep);
    CHECK(red[3] == "0.570000000");
    CHECK(red[4] == "red");
    CHECK(std::stod(red[7]) == std::sin(57 * kMadeStep));
    CHECK(red[head.size() - 1].empty());
    const std::vector<std::string> axle = cells_of(lines[3 + 57 * 3]);
    CHECK(axle[4] == "axle");
    CHECK(axle[5] == "shaft");
    CHECK(axle[6].empty());
    CHECK(std::stod(axle[head.size() - 2]) == 3 * (57 * kMadeStep));
    CHECK(axle[head.size() - 1] == "3");
}

TEST_CASE("a span of the recording's time is exported, both ends included")
{
    const std::string file = make_recording("export_span.mcap");
    CHECK(lines_of(exported(file, {.span = {0.5, 0.52}})).size() == 1 + 3 * 3);
    CHECK(lines_of(exported(file, {.span = {1.99, {}}})).size() == 1 + 2 * 3);
}

TEST_CASE("events and collisions: text with commas and quotes is quoted, entries are numbered")
{
    const std::string file = make_recording("export_events.mcap");
    const std::string events = exported(file, {.topics = {"events"}});
    CHECK(events.find("1,30,0.301,0.300000000,1,script.print,info,gears,red,,\"a \"\"quoted\"\", word\",1.5 2\n") != std::string::npos);
    const std::vector<std::string> collisions = lines_of(exported(file, {.topics = {"plab/collisions"}}));
    REQUIRE(collisions.size() == 11);
    CHECK(collisions[2] == "1,20,0.202,0.200000000,2,impact,contact.detection,red,floor,1,2,3,0,0,1,0,0,0.5,0.125");
}

TEST_CASE("every table row has as many cells as the header")
{
    const std::string file = make_recording("export_cells.mcap", {.steps_after = 20});
    auto log = Log::open(file);
    REQUIRE(log.ok());
    const std::string folder = fresh_path("tables") + "/";
    const auto done = export_csv(*log, {.out = folder});
    REQUIRE(done.ok());
    CHECK(done->files.size() == 9);  // of ten topics all but the scene
    for (const std::string& name : done->files)
    {
        const std::vector<std::string> lines = lines_of(content_of(name));
        REQUIRE_MESSAGE(lines.size() > 1, name);
        if (name.ends_with("events.csv")) continue;  // its texts have commas
        for (const std::string& line : lines) CHECK_MESSAGE(cells_of(line).size() == cells_of(lines[0]).size(), name << ": " << line);
    }
}

TEST_CASE("hashes have a row per step")
{
    const std::vector<std::string> lines = lines_of(exported(make_recording("export_hashes.mcap"), {.topics = {"hashes"}}));
    REQUIRE(lines.size() == 201);
    CHECK(lines[0] == "run,step,time_s,log_time_s,state_hash");
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(made_hash(1, 123, false)));
    CHECK(lines[124].starts_with("1,123,,"));
    CHECK(lines[124].ends_with(hash));
}

TEST_CASE("lines of JSON hold complete messages, decoded by the file's own schemas")
{
    const std::string file = make_recording("export_json.mcap");
    const std::vector<std::string> states = lines_of(exported(file, {.topics = {"states"}}, false));
    REQUIRE(states.size() == 201);
    const Json frame = Json::parse(states[57]);
    CHECK(frame["topic"] == "plab/states");
    CHECK(frame["log_time"] == 57 * kMadeStepNs);
    CHECK(frame["publish_time"] == kMadeStart + 57 * kMadeStepNs);
    CHECK(frame["message"]["step"] == 57);
    CHECK(frame["message"]["bodies"][0]["position"]["y"] == std::sin(57 * kMadeStep));
    CHECK(frame["message"]["shafts"][0]["speed"] == 3);
    const std::vector<std::string> journal = lines_of(exported(file, {.topics = {"journal"}}, false));
    REQUIRE(journal.size() == 1);
    const Json swap = Json::parse(journal[0]);
    CHECK(swap["message"]["client"].size() == 16);
    CHECK(swap["message"]["client"][0] == 0xab);
    CHECK(swap["message"]["operations"][0]["argument"] == "Response/None");
}

TEST_CASE("without a selection JSON has all topics except snapshots, in the order of time")
{
    const std::vector<std::string> lines = lines_of(exported(make_recording("export_all.mcap"), {}, false));
    std::uint64_t last = 0;
    std::set<std::string> topics;
    for (const std::string& line : lines)
    {
        const Json message = Json::parse(line);
        CHECK(message["log_time"] >= last);
        last = message["log_time"];
        topics.insert(message["topic"]);
    }
    CHECK(topics.size() == 9);
    CHECK(!topics.contains("plab/snapshots"));
}

TEST_CASE("topics that cannot be exported are refused_export with a list of those that can")
{
    const std::string file = make_recording("export_refused.mcap");
    CHECK(refused_export(file, {.topics = {"state"}}).find("did you mean 'plab/states'") != std::string::npos);
    CHECK(refused_export(file, {.topics = {"scene"}}).find("those that have one: plab/states") != std::string::npos);
    CHECK(refused_export(file, {.topics = {"states", "events"}}).find("several tables need a folder") != std::string::npos);
    CHECK(refused_export(file, {.out = fresh_path("no/such/folder/x.csv")}).find("cannot write") != std::string::npos);
}
