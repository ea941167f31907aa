/// Levels of detail: what a governor sees in Phase::Decide and what it can ask for, and the viewers for whom the scene is shown.
///
/// A *level* is one algorithm of a family, with its parameters; a *ladder* is a list of levels from the cheapest to the most exact one.
/// server/docs/levels.md explains them.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "plab/ref.h"
#include "plab/tables.h"

namespace plab
{

/// From where somebody looks at the scene. In W, SI units.
struct Viewpoint
{
    std::uint32_t component = kNoIndex;  ///< directory index of the viewer
    Vec3 position, velocity;             ///< m, m/s
    Vec3 direction{1, 0, 0};             ///< unit
    Vec3 up{0, 0, 1};                    ///< not parallel to the direction
    double field_of_view = 0.7;          ///< rad, vertical
    double width = 1280, height = 720;   ///< pixels
};

/// Phase::View: receives the viewers of the scene.
class ViewpointSink
{
public:
    virtual ~ViewpointSink() = default;
    virtual void add(Row row, const Viewpoint& viewpoint) = 0;
};

/// A component whose level a governor chooses, as it is at the present boundary.
struct GovernedComponent
{
    std::uint32_t component = kNoIndex;  ///< directory index
    std::int32_t level = -1;             ///< position in the ladder; -1: it has an algorithm that the ladder does not name
    double since = 0;                    ///< s, when it got this level
    Vec3 center;                         ///< W, m: of a ball around all objects on which it acts
    double radius = 0;                   ///< m, of that ball; infinite: it acts on something without bounds
    double speed = 0;                    ///< m/s, the largest speed of their centres: a turn does not take an object out of the ball
    std::uint32_t objects = 0;           ///< their number; static ones do not count
};

/// How far the objects of a component depart, within an interval, from where the next finer level of the ladder would take them. The
/// largest one of all objects counts. NaN: it cannot be told, or no object has it.
struct LevelError
{
    double distance = std::numeric_limits<double>::quiet_NaN();  ///< m, of a point of a body
    double angle = std::numeric_limits<double>::quiet_NaN();     ///< rad: the turn of a body, or of a shaft
    /// J/s: energy, kinetic and stored, that the island makes or loses with one level and not with the other, at most, divided by the
    /// interval. Told only to a governor whose field `unit` is "W".
    double power = std::numeric_limits<double>::quiet_NaN();
};

/// What Phase::Decide offers to governors. Each row has a ladder and a list of components, which the host derives from the fields `watches`
/// and `levels` of the row whenever the structure of the scene changes.
class LevelControl
{
public:
    virtual ~LevelControl() = default;
    virtual std::int32_t levels(Row row) const = 0;
    /// In the order of ids, looked up at the present boundary; valid until the call returns.
    virtual std::span<const GovernedComponent> watched(Row row) = 0;
    virtual std::span<const Viewpoint> viewpoints() const = 0;
    virtual std::string_view id_of(std::uint32_t component) const = 0;
    /// Measured by a trial step with this level and one with the next finer one, from the present state, which they do not change. What
    /// differs then is taken to add up over `interval` (s). The most exact level has no error.
    virtual LevelError error(Row row, std::size_t index, std::int32_t level, double interval) = 0;
    /// Tells observers what is known of a component: the error of the level that it is going to have, in the governor's unit, and when it
    /// is looked at again (s). To be called after choose(). Not state: a decision cannot depend on it.
    virtual void tell(Row row, std::size_t index, double error, std::string_view unit, double next_look) = 0;
    /// Asks for another level, from the coming step on. `reason`: in words, for people.
    virtual void choose(Row row, std::size_t index, std::int32_t level, std::string reason) = 0;
};

/// Phase::Decide: requests that a component makes in its own name, in the words of a client's request (server/docs/requests.md). They take
/// effect before the coming step, each as one transaction, in the order in which they were asked. A refusal is an event.
class RequestSink
{
public:
    virtual ~RequestSink() = default;
    virtual void ask(Row row, std::string_view verb, std::string_view target, std::string_view argument, std::string reason) = 0;
};

}  // namespace plab
