/// Compares the states of two recordings: at the steps that both have, object by object.
#pragma once

#include <array>
#include <compare>
#include <functional>
#include <set>
#include <span>

#include "control/recording/analysis/log.h"
#include "control/recording/analysis/stream.h"

namespace plab::analysis
{

/// A position in a recording: its n-th run (from 0), and the step in it.
struct When
{
    std::size_t run = 0;
    std::int64_t step = 0;

    auto operator<=>(const When&) const = default;
};

struct ComponentPair
{
    std::string_view name;  ///< "position.x"
    double a = 0, b = 0;
};
/// |a - b|; 0 if both are NaN, infinite if only one is.
double size_of(const ComponentPair& pair);
/// The largest of them.
double size_of(std::span<const ComponentPair> pairs);

/// An object that both have. Either both bodies are set or both shafts.
struct ComparedObject
{
    std::string id;
    const plab_v2_BodyState* body_a = nullptr;
    const plab_v2_BodyState* body_b = nullptr;
    const plab_v2_ShaftState* shaft_a = nullptr;
    const plab_v2_ShaftState* shaft_b = nullptr;
    std::span<const ComponentPair> differences;  ///< all components, also those that are equal
};

struct ComparedFrame
{
    When when;
    double time = 0;      ///< s, simulated
    double log_time = 0;  ///< s, of A's time line
};

class Comparison
{
public:
    Comparison(const Log& a, const Log& b);

    /// Advances to the next step that both have. False: there is none.
    bool next();
    const ComparedFrame& frame() const { return frame_; }
    /// Objects that both have at this step, by their handles in A.
    void for_each(const std::function<void(const ComparedObject&)>& use);

    std::uint64_t frames_a() const { return a_.frames; }
    std::uint64_t frames_b() const { return b_.frames; }
    std::uint64_t compared() const { return compared_; }
    std::vector<std::string> only_in_a() const { return {only_a_.begin(), only_a_.end()}; }
    std::vector<std::string> only_in_b() const { return {only_b_.begin(), only_b_.end()}; }
    const Troubles& troubles_a() const { return a_.stream.troubles(); }
    const Troubles& troubles_b() const { return b_.stream.troubles(); }

private:
    struct Side
    {
        explicit Side(const Log& from) : log(&from), stream(from.stream({"plab/states"})), runs(from.runs()) {}
        /// False at the end.
        bool next();
        std::optional<std::uint32_t> handle_of(const std::string& id, std::uint32_t handle) const;

        const Log* log;
        Stream stream;
        Runs runs;
        Merged merged;
        When when;
        double log_time = 0;
        std::uint64_t frames = 0;
    };
    /// The same object in B, and its name.
    struct Partner
    {
        std::string id;
        std::optional<std::uint32_t> handle;
    };
    const Partner& partner_of(std::uint32_t handle);
    void note_missing();

    Side a_, b_;
    bool a_is_there_, b_is_there_;
    bool is_begun_ = false;
    ComparedFrame frame_;
    std::uint64_t compared_ = 0;
    std::map<std::uint32_t, Partner> partners_;  ///< by handle in A, of the runs that are compared now
    std::pair<std::uint64_t, std::uint64_t> partners_of_{};
    std::set<std::string> only_a_, only_b_;
    std::array<ComponentPair, 13> pairs_;
};

}  // namespace plab::analysis
