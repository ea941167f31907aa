#include "control/recording/player/terminal.h"

#include <doctest/doctest.h>

using namespace plab::player;
using Keys = std::vector<Key>;

TEST_CASE("keys are distinguished, also when a cursor key arrives byte by byte, and others are ignored")
{
    KeyParser parser;
    CHECK(parser.take(" ") == Keys{Key::Pause});
    CHECK(parser.take("\033[A\033[B\033[C\033[D") == Keys{Key::Faster, Key::Slower, Key::Forward, Key::Back});
    CHECK(parser.take("\033OC") == Keys{Key::Forward});
    CHECK(parser.take("\033").empty());
    CHECK(parser.take("[").empty());
    CHECK(parser.take("D") == Keys{Key::Back});
    CHECK(parser.take("\033[5~x\033[1;5C") == Keys{Key::Forward});  // page up, a letter, control with right
    CHECK(parser.take("C").empty());
    CHECK(parser.take("\033q").empty());  // Alt with q
    CHECK(parser.take("q") == Keys{Key::Quit});
}

TEST_CASE("the bar shows the position of the playback, in the width available")
{
    BarState state{2, 12, 7, 1, false, 3.25, 4};
    const std::string wide = bar(state, 120);
    CHECK(wide == "1x  [===================>....................]  7.00 / 12.00 s  t = 3.250 s, run 4  (space, arrows, q)");
    const std::string narrow = bar(state, 60);
    CHECK(narrow.size() <= 60);
    CHECK(narrow.find("(space") == std::string::npos);
    CHECK(narrow.find("[") != std::string::npos);
    CHECK(bar(state, 20) == "1x    7.00 / 12.00 s  t = 3.250 s, run 4");
    state.is_paused = true, state.at = 12, state.rate = 0.5;
    CHECK(bar(state, 120).starts_with("paused 0.5x  [=======================================>]"));
}
