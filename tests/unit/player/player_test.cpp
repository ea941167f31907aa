// A playback as clients see it: a server whose runs begin again, and that refuses all requests.
#include "both.h"
#include "link/caller.h"
#include "link/catalogue.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// What a reader of the log and of the states has received.
class Watcher
{
public:
    explicit Watcher(const std::string& name)
        : session_(watch(name)), events_(session_.reader<plab_v2_Events>().take()), frames_(session_.reader<plab_v2_Frame>().take())
    {
    }
    void take()
    {
        take_all(events_, [&](const plab_v2_Events& e) { numbers.emplace_back(e.sequence_number), event_runs.push_back(e.run); });
        take_all(frames_,
                 [&](const plab_v2_Frame& f)
                 {
                     frame_numbers.push_back(f.sequence_number);
                     if (runs.empty() || runs.back() != f.run) runs.push_back(f.run), first_times.push_back(f.time);
                     last_time = f.time;
                 });
    }
    bool is_matched() const { return events_.writers() > 0 && frames_.writers() > 0; }
    const link::Session& session() const { return session_; }

    std::vector<std::uint64_t> numbers, event_runs, frame_numbers, runs;
    std::vector<double> first_times;
    double last_time = -1;

private:
    link::Session session_;
    wire::DataReader<plab_v2_Events> events_;
    wire::DataReader<plab_v2_Frame> frames_;
};

bool has_no_gap(const std::vector<std::uint64_t>& numbers)
{
    for (std::size_t i = 1; i < numbers.size(); ++i)
        if (numbers[i] != numbers[i - 1] + 1) return false;
    return !numbers.empty();
}

std::uint64_t ns(double seconds) { return static_cast<std::uint64_t>(seconds * 1e9); }

}  // namespace

TEST_CASE("each repetition of a loop is a new run from its beginning, and numbers continue without a gap")
{
    player::PlaybackOptions options = play_options(make_recording("playback_loop.mcap"), "loop");
    options.from = 0.5, options.to = 1.5, options.rate = 10, options.loop = true, options.readers = 1;
    auto player = open_player(options);
    Watcher watcher("loop");
    CHECK(play_until(*player, [&] { return watcher.take(), watcher.runs.size() >= 4; }));
    REQUIRE(watcher.runs.size() >= 4);
    for (std::size_t i = 0; i < 4; ++i)
    {
        CHECK(watcher.runs[i] == i + 1);
        // The state just before the first time is sent first.
        CHECK(watcher.first_times[i] == doctest::Approx(0.49));
    }
    CHECK(has_no_gap(watcher.numbers));
    CHECK(watcher.numbers.size() >= 3);
    // A reader keeps four frames, so on a busy machine it misses some. None has the number of an earlier one.
    CHECK(std::is_sorted(watcher.frame_numbers.begin(), watcher.frame_numbers.end(), std::less_equal<>()));
}

TEST_CASE("a jump publishes the catalogue of that time; backwards it is a new run, forwards it is not")
{
    player::PlaybackOptions options = play_options(make_recording("playback_seek.mcap"), "seek");
    options.from = 0.2, options.paused = true;
    auto player = open_player(options);
    Watcher watcher("seek");
    auto catalogue = link::Catalogue::open(watcher.session(), link::Part::Interactions | link::Part::Objects);
    REQUIRE(catalogue.ok());
    const auto shows = [&](const char* type, std::uint64_t run)
    {
        return play_until(*player,
                          [&]
                          {
                              (void)catalogue->update();
                              watcher.take();
                              const auto& all = catalogue->now().interactions;
                              const auto found = all.find("contact.response");
                              return found != all.end() && found->second.type_name == type && found->second.run == run;
                          });
    };
    CHECK(shows("Response/Impulse", 1));
    CHECK(play_until(*player, [&] { return watcher.take(), watcher.last_time > 0.19; }));  // a late reader receives the present state
    player->seek(ns(1.7), Clock::now());
    CHECK(shows("Response/None", 1));
    CHECK(play_until(*player, [&] { return watcher.take(), watcher.last_time > 1.69; }));
    CHECK(watcher.last_time < 1.71);
    CHECK(watcher.runs == std::vector<std::uint64_t>{1});
    player->seek(ns(0.9), Clock::now());
    CHECK(shows("Response/Impulse", 2));
    CHECK(play_until(*player, [&] { return watcher.take(), watcher.last_time > 0.895 && watcher.last_time < 0.905; }));
    CHECK(watcher.last_time == doctest::Approx(0.9));
    CHECK(catalogue->now().objects.at("red").run == 2);
    CHECK(has_no_gap(watcher.frame_numbers));
    CHECK(catalogue->now().server->paused);
    CHECK(catalogue->now().server->run == 2);
    CHECK(play_until(*player, [&] { return catalogue->update() && std::abs(catalogue->now().server->time - 0.9) < 1e-9; }));
}

TEST_CASE("a request is refused, with the reason")
{
    player::PlaybackOptions options = play_options(make_recording("playback_asked.mcap"), "asked");
    options.paused = true;
    auto player = open_player(options);
    const link::Session session = watch("asked");
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE_MESSAGE(caller.ok(), caller.error().text());
    const auto number = caller->send({{{"pause"}}, {}, {}});
    REQUIRE(number.ok());
    std::optional<link::Reply> reply;
    REQUIRE(play_until(*player,
                       [&]
                       {
                           caller->take(
                               [&](std::uint64_t n, link::Reply r)
                               {
                                   if (n == *number) reply = std::move(r);
                               });
                           return reply.has_value();
                       }));
    CHECK(reply->outcome == "refused");
    REQUIRE(reply->reasons.size() == 1);
    CHECK(reply->reasons[0].starts_with("this is a playback of "));
}

TEST_CASE("a second player of one name is refused until the first has ended")
{
    const std::string file = make_recording("playback_twice.mcap");
    auto first = open_player(play_options(file, "twice"));
    const auto second = player::Player::open(play_options(file, "twice"));
    REQUIRE_FALSE(second.ok());
    CHECK(second.error().text().find("a server 'twice' is already running on this host") == 0);
    first.reset();
    CHECK(player::Player::open(play_options(file, "twice")).ok());
}

TEST_CASE("for files that cannot be played the error says why")
{
    const std::string file = make_recording("playback_wrong.mcap");
    player::PlaybackOptions options = play_options(file, "wrong");
    options.from = 3;
    const auto beyond = player::Player::open(options);
    REQUIRE_FALSE(beyond.ok());
    CHECK(beyond.error().text().find("has no messages from 3.0") != std::string::npos);
    options.from = 1.5, options.to = 1;
    CHECK_FALSE(player::Player::open(options).ok());
    CHECK_FALSE(player::Player::open(play_options(file, "a/b")).ok());
    CHECK_FALSE(player::Player::open(play_options(fresh_path("playback_none.mcap"), "x")).ok());
    player::PlaybackOptions unnamed = play_options(file, "");
    auto player = player::Player::open(unnamed);
    REQUIRE(player.ok());
    CHECK((*player)->name() == "lab");  // the recorded server's
}
