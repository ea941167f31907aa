/// Signals: the numbers over time that the messages of a recording contain, by the names that --quantity takes: "red.position.z",
/// "axle.speed", "contact.response.cost", "energy.kinetic".
///
/// Bodies: position (m), orientation, velocity or linear_velocity (m/s), angular_velocity (rad/s), with .x .y .z (.w of an
/// orientation) or .norm; speed (m/s). Shafts: angle (rad), speed (rad/s). Interactions: cost (ns per step), error, work
/// (J), and their outputs by name. The scene: energy.kinetic .stored .total .work .of_requests .unexplained (J), momentum
/// (N s), angular_momentum (N m s), real_time_factor, step_cost (ns), contacts, deepest (m), residual (m/s).
/// A vector without a component stands for all of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/recording/analysis/log.h"
#include "control/recording/analysis/stream.h"

namespace plab::analysis
{

struct Signal
{
    enum class Source : std::uint8_t
    {
        Object,
        Interaction,
        Scene,
    };
    Source source = Source::Scene;
    std::string id;         ///< of an object or interaction
    std::string what;       ///< "position", "cost", "energy.kinetic"
    std::string component;  ///< "x" "y" "z" "w" "norm", or ""
    std::string unit;       ///< of quantities with a fixed unit; outputs give theirs in each sample

    std::string name() const;
};

/// An error lists similar existing ids or quantities.
Result<std::vector<Signal>> parse_signal(const std::string& text, const Things& things);

/// All quantities that can be named in a recording of these, except outputs of interactions: for the completion of command lines.
std::vector<std::string> signal_names(const Things& things);

/// Measured over the time since the previous sample: a cost, the pace. In the first sample of a run, that time extends to
/// before the run, across a load, a rewind or a restore and the steps that were repeated for it: it is not a figure of the run.
bool is_measured(const Signal& signal);

/// Empty: the sample does not contain it.
std::optional<double> value_of(const Signal& signal, const plab_v2_BodyState& body);
std::optional<double> value_of(const Signal& signal, const plab_v2_ShaftState& shaft);
std::optional<double> value_of(const Signal& signal, const plab_v2_Metrics& metrics);
/// Unit of an output of an interaction; "" if there is none.
std::string unit_in(const Signal& signal, const plab_v2_Metrics& metrics);

/// sqrt(x^2 + y^2 + z^2)
double norm(const plab_v2_Vector& v);

}  // namespace plab::analysis
