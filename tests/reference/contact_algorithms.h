/// Every way to answer a contact, and tables that say how far off each may be.
///
/// A line of a table is for a set of algorithms; the first line that fits a algorithm counts. Each algorithm needs a line and each line a
/// algorithm, so that whoever adds a algorithm has to state its bound.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "support/text.h"

namespace plab::test
{

/// Who finds the time, who answers, and for rows by which manager.
struct Algorithm
{
    const char* resolution;
    const char* response;
    const char* manager = "Direct";

    bool rows() const { return std::string_view(response) == "Rows"; }
    bool springs() const { return std::string_view(response) == "Penalty" || std::string_view(response) == "HuntCrossley"; }
    bool locates() const { return !is("None") && !is("Speculative"); }
    bool certifies() const { return is("LocalRoot") || is("ConservativeAdvancement"); }
    bool is(std::string_view wanted) const { return resolution == wanted; }
    bool by(std::string_view wanted) const { return rows() && manager == wanted; }
    std::string law() const { return std::string(response) + (rows() ? std::string("/") + manager : ""); }
    std::string name() const { return std::string(resolution) + " + " + law(); }
};

/// Resolution x response x manager: all that hosts take (unit test contact_rules says what they refuse). Springs look for themselves
/// when they touch, so no resolution changes what they do. Response/None answers nothing: sensor().
inline std::vector<Algorithm> every_algorithm()
{
    std::vector<Algorithm> out;
    for (const char* resolution : {"None", "Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
        out.push_back({resolution, "Impulse"});
    for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
        for (const char* resolution : {"None", "Speculative", "Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
            out.push_back({resolution, "Rows", manager});
    out.push_back({"None", "Penalty"});
    out.push_back({"None", "HuntCrossley"});
    return out;
}

/// Those for things that stay in touch. Left out are resolutions that locate, with managers that sweep: a second of C16 (Bisection,
/// SequentialImpulse) did not end within a minute.
inline std::vector<Algorithm> standing_algorithms()
{
    std::vector<Algorithm> out = every_algorithm();
    std::erase_if(out, [](const Algorithm& r) { return r.locates() && r.rows() && !r.by("Direct"); });
    return out;
}

inline std::string contact(const std::string& between, const Algorithm& algorithm, double restitution, double friction = 0,
                           const std::string& more = "")
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + between + "\" resolution=\"Resolution/" + algorithm.resolution +
           "\" response=\"Response/" + algorithm.response + "\" response.restitution=\"" + text(restitution) + "\" response.friction=\"" +
           text(friction) + "\"" + (algorithm.rows() ? std::string(" response.manager=\"Manager/") + algorithm.manager + "\"" : "") + " " +
           more + "/>";
}
/// `more` of contact(): what springs need beside what all take.
inline std::string stiffness(const Algorithm& algorithm, double linear, double hertz, const std::string& more = "")
{
    if (!algorithm.springs()) return "";
    return "response.stiffness=\"" + text(std::string_view(algorithm.response) == "Penalty" ? linear : hertz) + "\" " + more;
}

/// Restitution where nothing is to bounce. HuntCrossley creeps back in thousands of pieces where little comes back: .5 is enough for what
/// only has to settle.
inline double plastic(const Algorithm& algorithm) { return std::string_view(algorithm.response) == "HuntCrossley" ? 0.5 : 0; }

/// Most, and least, of N figures. What a algorithm does badly has a least: less than that is news.
template <std::size_t N>
struct Bound
{
    /// "located", "certified", "halved" (by bisections), "at ends" (None, Speculative), "*", or a resolution.
    const char* when;
    /// "*", "springs", or how a law begins: "Impulse", "Rows", "Rows/SoftStep", "Penalty".
    const char* who;
    std::array<double, N> most;
    std::array<double, N> least = {};

    bool fits(const Algorithm& algorithm) const
    {
        const std::string_view time = when, answer = who;
        const bool at_time = time == "*" || algorithm.is(time) || (time == "located" && algorithm.locates()) ||
                             (time == "certified" && algorithm.certifies()) ||
                             (time == "halved" && algorithm.locates() && !algorithm.certifies()) ||
                             (time == "at ends" && !algorithm.locates());
        const bool by_law = answer == "*" || (answer == "springs" && algorithm.springs()) || algorithm.law().rfind(answer, 0) == 0;
        return at_time && by_law;
    }
};

/// `measure(algorithm)` gives the figures of each of `algorithms`.
template <std::size_t N, std::size_t Lines, class Measure>
void check_algorithms(const std::vector<Algorithm>& algorithms, const Bound<N> (&table)[Lines], const Measure& measure)
{
    std::array<bool, Lines> used{};
    for (const Algorithm& algorithm : algorithms)
    {
        CAPTURE(algorithm.name());
        const auto line = std::find_if(std::begin(table), std::end(table), [&](const Bound<N>& b) { return b.fits(algorithm); });
        REQUIRE(line != std::end(table));
        used[static_cast<std::size_t>(line - std::begin(table))] = true;
        const std::array<double, N> figures = measure(algorithm);
        for (std::size_t figure = 0; figure < N; ++figure)
        {
            CAPTURE(figure);
            CHECK(figures[figure] <= line->most[figure]);
            if (line->least[figure] > 0) CHECK(figures[figure] >= line->least[figure]);
        }
    }
    for (std::size_t i = 0; i < Lines; ++i)
        CHECK_MESSAGE(used[i], "no algorithm has the line ", std::string(table[i].when), " + ", std::string(table[i].who));
}

}  // namespace plab::test
