/// Resolution/Automatic: locates impacts while that is affordable, and leaves them to the manager where bodies are many.
///
///   islands of at most `max_bodies` bodies and `max_points` contact points    Resolution/LocalRoot    (each impact at its time)
///   larger, and some body is fast for its size                               Resolution/Speculative  (no tunnelling, nothing is rewound)
///   larger                                                                   Resolution/None
///
/// An island is what persistent contacts and the joints of touching bodies hold together. An impact rewinds and solves the whole island of
/// its bodies, so the cost of locating all impacts of a step grows with the square of the largest island, and not with the number of bodies
/// that fly or rest apart. So each island has its own choice: of balls that bounce beside a heap the impacts are located, of the heap they
/// are not, and neither are those of a ball on the heap. Fast: within a step a point of a body moves by more than 1/32 of its radius, or
/// one of a thin body by more than 1/64 of its thickness.
///
/// The impacts of a body that was in a large island are located again only when its island has been small for `dwell`: the feet of a robot
/// that lands lift off for a few steps at a time, and each of its impacts costs as much as a step of all that its joints hold.
///
/// Responses without a manager have one choice for all islands. Of several detections with a response, the smallest limits and the longest
/// dwell hold for all.
///
/// The choice follows from the state at the start of the step alone, so that rewinds, trials and replays make the same one. `resolved`
/// names it and `reason` says why; resolution.chosen reports each change.
#pragma once

#include "searches.h"

namespace plab::resolution
{

struct AutomaticRows
{
    RootRows root;
    Column<double> base_work;                     // 1
    Column<double> acceleration;                  // m/s^2
    Column<std::int64_t> max_located;             // bodies of the scene
    Column<std::int64_t> max_bodies, max_points;  // of an island; read by the host, as is dwell (ContactLoad::crowded)
    Column<double> dwell;                         // s
    Column<std::string> resolved, reason;

    void describe(Schema& schema);
};
/// Phase::Choose.
void choose_search(const StepContext& context, Row row, AutomaticRows& rows, ContactLoad& load);
/// Phase::Locate, in steps in which impacts are located.
void find_root_automatically(const StepContext& context, Row row, const AutomaticRows& rows, EventBracket& trial);

}  // namespace plab::resolution
