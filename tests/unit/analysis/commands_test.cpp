// plabctl on files, as its user sees it: its output and its exit codes. No server, no bus.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "made_recording.h"
#include "support/process.h"
#include "support/text.h"

using namespace plab::test;
using Json = nlohmann::ordered_json;

namespace
{

Outcome plabctl(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), program("plabctl"));
    return run(std::move(arguments));
}

std::size_t lines_in(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); }

/// A recording whose last third is missing.
std::string cut_recording(const std::string& name)
{
    const std::string path = make_recording(name);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
    return path;
}

}  // namespace

TEST_CASE("info: as text and as JSON")
{
    const std::string file = make_recording("cli_info.mcap", {.steps_after = 50, .missing_frame = 77});
    const Outcome text = plabctl({"info", file});
    CHECK(text.code == 0);
    CHECK(text.errors.empty());
    for (const char* part : {"whole", "lab on here, pLab 0.2.0", "2.51 s simulated in 2 runs", "1 in 1 gap",
                             "Response/Impulse  Response/None", "reset", "script.print      warning", "plab::v2::Frame"})
        CHECK_MESSAGE(has(text.output, part), part << " in\n" << text.output);
    const Outcome json = plabctl({"info", file, "--json"});
    CHECK(json.code == 0);
    const Json summary = Json::parse(json.output);
    CHECK(summary["whole"] == true);
    CHECK(summary["runs"].size() == 2);
    CHECK(summary["runs"][1]["cause"] == "reset");
    CHECK(summary["swaps"][0]["to"] == "Response/None");
    CHECK(summary["swaps"][0]["at"] == 1.0);
    CHECK(summary["duration"] == 2.51);
    CHECK(summary["head"]["server"] == "lab");
    const Outcome cut = plabctl({"info", cut_recording("cli_info_cut.mcap")});
    CHECK(cut.code == 0);
    CHECK(has(cut.output, "truncated: it was not closed"));
}

TEST_CASE("export: tables and lines, to a file or a pipe")
{
    const std::string file = make_recording("cli_export.mcap");
    const Outcome states = plabctl({"export", file, "--csv", "--from", "0.5", "--to", "0.6"});
    CHECK(states.code == 0);
    CHECK(lines_in(states.output) == 1 + 11 * 3);
    const std::string folder = fresh_path("cli_tables") + "/";
    CHECK(plabctl({"export", file, "--csv", "-o", folder}).code == 0);
    CHECK(std::filesystem::exists(folder + "states.csv"));
    CHECK(std::filesystem::exists(folder + "metrics.csv"));
    const Outcome json = plabctl({"export", file, "--json", "--topic", "journal", "--topic", "plab/scene"});
    CHECK(json.code == 0);
    CHECK(lines_in(json.output) == 2);
    CHECK(plabctl({"export", file}).code == 2);
    CHECK(plabctl({"export", file, "--csv", "--json"}).code == 2);
    CHECK(plabctl({"export", file, "--csv", "--from", "2", "--to", "1"}).code == 2);
    CHECK(plabctl({"export", file, "--csv", "--from", "soon"}).code == 2);
    const Outcome wrong = plabctl({"export", file, "--csv", "--topic", "state"});
    CHECK(wrong.code == 1);
    CHECK(has(wrong.errors, "did you mean 'plab/states'"));
    CHECK(plabctl({"export", file + ".not", "--csv"}).code == 1);
}

TEST_CASE("exit codes of recover: 0 whole, 5 something lost, 1 nothing usable")
{
    const std::string out = fresh_path("cli_recovered.mcap");
    const Outcome whole = plabctl({"recover", make_recording("cli_whole.mcap"), "-o", out});
    CHECK(whole.code == 0);
    CHECK(has(whole.output, "written to " + out));
    std::filesystem::remove(out);
    const Outcome cut = plabctl({"recover", cut_recording("cli_cut.mcap"), "-o", out});
    CHECK(cut.code == 5);
    CHECK(has(cut.output, "plab/states: "));
    CHECK(has(cut.output, "lost: "));
    CHECK_MESSAGE(has(cut.output, "lost: what was recorded after "), cut.output);
    CHECK_MESSAGE(!has(whole.output, "lost: "), whole.output);
    // The recovered file is undamaged, but still not the whole recording.
    const Outcome info = plabctl({"info", out});
    CHECK_MESSAGE(has(info.output, "recovered: something is lost"), info.output);
    CHECK_MESSAGE(has(info.output, "what was recorded after "), info.output);
    CHECK(!has(info.output, "whole"));
    const Json summary = Json::parse(plabctl({"info", out, "--json"}).output);
    CHECK(summary["whole"] == false);
    CHECK(summary["closed"] == true);
    CHECK(summary["not_recovered"].size() >= 1);
    const std::string page = fresh_path("cli_recovered.html");
    CHECK(plabctl({"report", out, "-o", page}).code == 0);
    CHECK(!has(content_of(page), "is complete"));
    CHECK(has(content_of(page), "recovered from a recording that had lost some data"));
    CHECK(has(content_of(page), "lost, and not recovered: "));
    // It is not overwritten.
    CHECK(plabctl({"recover", make_recording("cli_whole.mcap"), "-o", out}).code == 1);
    const std::string none = fresh_path("cli_none.mcap");
    std::ofstream(none) << "nothing of the kind";
    const Outcome nothing = plabctl({"recover", none, "--json"});
    CHECK(nothing.code == 1);
    CHECK(Json::parse(nothing.output)["verdict"] == "nothing usable");
    CHECK(!std::filesystem::exists(fresh_path("cli_none.recovered.mcap")));
}

TEST_CASE("a file that is being written gets its name when it is complete")
{
    const std::string file = make_recording("cli_named_late.mcap"), out = fresh_path("cli_states.csv");
    std::ofstream(out) << "what was there before";
    CHECK(plabctl({"export", file, "--csv", "--topic", "none", "-o", out}).code == 1);
    CHECK(content_of(out) == "what was there before");
    CHECK(plabctl({"export", file, "--csv", "-o", out}).code == 0);
    CHECK(lines_in(content_of(out)) == 1 + 201 * 3);
    CHECK(!std::filesystem::exists(out + ".part"));
    CHECK(plabctl({"export", file, "--csv", "-o", "/dev/null"}).code == 0);
    CHECK(std::filesystem::is_character_file("/dev/null"));
    const std::string link = fresh_path("cli_link.csv");
    std::filesystem::create_symlink(out, link);
    CHECK(plabctl({"export", file, "--csv", "--topic", "hashes", "-o", link}).code == 0);
    CHECK(std::filesystem::is_symlink(link));
    CHECK(content_of(out).starts_with("run,step"));
}

TEST_CASE("recover names its file after the original")
{
    const std::string file = make_recording("cli_named.mcap");
    const std::string expected = fresh_path("cli_named.recovered.mcap");
    CHECK(plabctl({"recover", file}).code == 0);
    CHECK(std::filesystem::exists(expected));
}

TEST_CASE("diff: exit code 0 without a difference, 1 with one")
{
    const std::string a = make_recording("cli_diff_a.mcap"), b = make_recording("cli_diff_b.mcap", {.differs_from = 57});
    const Outcome same = plabctl({"diff", a, a});
    CHECK(same.code == 0);
    CHECK(has(same.output, "equal at all 200 steps"));
    const std::string picture = fresh_path("cli_growth.svg");
    const Outcome other = plabctl({"diff", a, b, "--plot", picture});
    CHECK(other.code == 1);
    CHECK(has(other.output, "first differ at step 57"));
    CHECK(has(other.output, "red position.y"));
    CHECK(std::filesystem::file_size(picture) > 1000);
    const Json json = Json::parse(plabctl({"diff", a, b, "--json"}).output);
    CHECK(json["same"] == false);
    CHECK(json["states"]["first_difference"]["object"] == "red");
    CHECK(json["hashes"]["first_difference"]["step"] == 57);
    const std::string empty = make_recording("cli_diff_none.mcap", {.steps = 0, .frame_every = 7, .with_hashes = false});
    CHECK(plabctl({"diff", a, empty}).code == 0);  // the first step is the same
    CHECK(plabctl({"diff", a}).code == 2);
    const Outcome longer = plabctl({"diff", a, make_recording("cli_diff_runs.mcap", {.steps_after = 30})});
    CHECK(longer.code == 1);
    CHECK_MESSAGE(has(longer.output, "1 and 2: not compared, as only B has them: 2"), longer.output);
}

TEST_CASE("play refuses invalid times and rates before it joins the bus")
{
    const std::string file = make_recording("cli_play.mcap");
    for (const std::string rate : {"0", "5000", "-1", "fast"})
    {
        const Outcome refused = plabctl({"play", file, "--rate", rate});
        CHECK(refused.code == 2);
        CHECK_MESSAGE(has(refused.errors, "must be from 0.001 to 1000, not '" + rate + "'"), refused.errors);
    }
    const Outcome backwards = plabctl({"play", file, "--from", "5", "--to", "2"});
    CHECK(backwards.code == 2);
    CHECK_MESSAGE(has(backwards.errors, "--to is before --from"), backwards.errors);
}

TEST_CASE("plot and report write the files that they announce")
{
    const std::string file = make_recording("cli_plot.mcap");
    const std::string svg = fresh_path("cli_plot.svg"), png = fresh_path("cli_plot.png"), page = fresh_path("cli_report.html");
    CHECK(plabctl({"plot", file, "--quantity", "red.position.z", "-q", "axle.speed", "-o", svg}).code == 0);
    CHECK(plabctl({"plot", file, "-q", "contact.response.cost", "--from", "0.5", "-o", png}).code == 0);
    CHECK(std::filesystem::file_size(svg) > 1000);
    CHECK(std::filesystem::file_size(png) > 1000);
    CHECK(plabctl({"plot", file, "-q", "red.speed", "-o", "speed.gif"}).code == 2);
    CHECK(plabctl({"plot", file, "-o", svg}).code == 2);
    const Outcome unknown = plabctl({"plot", file, "-q", "rde.speed", "-o", svg});
    CHECK(unknown.code == 1);
    CHECK(has(unknown.errors, "did you mean 'red'"));
    const Outcome never = plabctl({"plot", file, "-q", "contact.response.heat", "-o", svg});
    CHECK(never.code == 1);
    CHECK(has(never.errors, "has no value of 'contact.response.heat'"));
    CHECK(plabctl({"report", file, "-o", page}).code == 0);
    CHECK(std::filesystem::file_size(page) > 10000);
    CHECK(plabctl({"report", file, "-o", "/nowhere/report.html"}).code == 1);
}

TEST_CASE("log of a file")
{
    const std::string file = make_recording("cli_log.mcap", {.steps_after = 50});
    CHECK(lines_in(plabctl({"log", file}).output) == 18);
    CHECK(lines_in(plabctl({"log", file, "--events"}).output) == 6);
    CHECK(lines_in(plabctl({"log", file, "--collisions", "--object", "floor"}).output) == 7);
    CHECK(lines_in(plabctl({"log", file, "--events", "--kind", "script.", "-n", "2"}).output) == 2);
    CHECK(has(plabctl({"log", file, "--json", "--severity", "warning"}).output, R"("severity":"warning")"));
    CHECK(plabctl({"log", file, "--severity", "loud"}).code == 2);
    CHECK(plabctl({"log", "--from", "1"}).code == 2);
    CHECK(plabctl({"log", file, "--from", "3", "--to", "2"}).code == 2);
    CHECK(plabctl({"log", file, "--kind", "collision.rest"}).code == 0);  // the kind exists, though not in this file
    for (const char* option : {"--kind", "--object"})
    {
        const auto none = plabctl({"log", file, option, "nope"});
        CHECK(none.code == 1);
        CHECK_MESSAGE(has(none.errors, "nope"), none.errors);
        CHECK(none.output.empty());
    }
}

TEST_CASE("damage is reported on standard error, and the exit code says that not everything was read")
{
    const std::string file = make_recording("cli_damaged.mcap", {.compression = plab::recording::Compression::None});
    {
        std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
        out.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
        out.write("damaged", 7);
    }
    const Outcome states = plabctl({"export", file, "--csv"});
    CHECK(states.code == 1);
    CHECK(has(states.errors, file));
    CHECK(lines_in(states.output) > 400);
}
