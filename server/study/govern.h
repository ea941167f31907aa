/// Governed levels of detail compared with one level for all: error against the run time of the whole scene (plab-study --govern).
///
/// Courses of chaotic mechanisms part whatever one does, so they are not compared as a whole. At the end of each interval, a second
/// simulation continues from the state of the run with the most exact level for all and a shorter step; after a short time the error is how
/// far the objects of the run are from those of the reference. What is compared is thus the error that a choice makes per interval.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "figures/drawing.h"
#include "model/scene.h"
#include "model/type_registry.h"
#include "plab/interruption.h"
#include "plab/result.h"
#include "study/settings.h"

namespace plab::study
{

struct GovernPlan
{
    model::SceneSpec scene;
    std::string title, command, governor;  ///< governor: pattern of ids; empty: the first one of the scene, by id
    double until = 10;                     ///< s
    double between = 1, window = 0.25;     ///< s: from one comparison to the next; of a comparison
    int refine = 4;                        ///< steps of the reference for each step of the run
    std::vector<Setting> variants;         ///< of the governors: for each one there is a governed run more
    const Interruption* stop = nullptr;
    std::function<void(const std::string&)> progress;
};

/// Error of the objects on which the watched components act and that a viewer sees, at the end of a window: their displacement
/// |dp| + r |angle|, in the plane of its picture. Of what no governor watches the choice changes nothing.
struct GovernError
{
    double pixels = 0, worst_pixels = 0;  ///< root mean square; largest
    double metres = 0;                    ///< root mean square of all of them, seen or not
    std::size_t seen = 0, bodies = 0;     ///< samples
    std::string worst;                    ///< the body with the largest one
    std::string worst_level;              ///< of the component that acts on it, at the end of that comparison
    double worst_at = 0;                  ///< s
};

/// s of CPU time, with what was decided before the step; how many levels were tried and components exchanged.
struct GovernStep
{
    double seconds = 0, deciding = 0;
    std::size_t trials = 0, exchanged = 0;
};

struct GovernPoint
{
    std::string name;  ///< "governed", with the setting of a variant, or the level that all have
    bool governed = false;
    double cpu = 0;  ///< s of CPU time for each simulated second: the whole scene, with all decisions
    double step_median = 0, step_99 = 0, step_longest = 0;  ///< s of CPU time
    GovernError error;
    std::vector<double> shares;     ///< mean fraction of the components at each level
    std::vector<GovernStep> steps;  ///< apart from those that copy what they share with a snapshot
};

struct GovernResult
{
    std::string title, scene_file, command, governor, type;         ///< governor, type: of several ones, all of them
    double until = 0, between = 0, window = 0, dt = 0, budget = 0;  ///< budget: s, of a step; 0: the governor has none
    int refine = 0;
    std::size_t components = 0, objects = 0;  ///< that are watched; on which they act
    std::vector<std::string> levels;          ///< of several governors: which one of each
    std::vector<GovernPoint> points;          ///< the governed one first, then its variants, then from the cheapest level on
};

/// Errors: the scene has no such governor or no viewer; it was interrupted.
Result<GovernResult> compare_governor(model::TypeSource& types, const GovernPlan& plan);

/// The governor of the plan and its levels, without figures. Errors as above.
Result<GovernResult> governed_levels(model::TypeSource& types, const GovernPlan& plan);

/// How many times the CPU time of a governed run one would need with a single level for its error: on the line that joins the levels
/// which no other level beats, in logarithms of both. More than 1: the governed point is below and left of it. Nothing: the governed run is
/// more exact than every level, or less exact than the cheapest one.
std::optional<double> gain(const GovernResult& result, const GovernPoint& governed);
/// Of the first one.
std::optional<double> gain(const GovernResult& result);
/// The governed run that is both cheaper and more exact than this level for all, the fastest one if there are several; null: there is none.
const GovernPoint* better_than(const GovernResult& result, const GovernPoint& fixed);

std::vector<std::string> govern_findings(const GovernResult& result);
figures::Drawing govern_picture(const GovernResult& result);
/// Writes report.html, govern.csv, steps.csv, govern.svg and govern.png.
Result<void> write_govern(const GovernResult& result, const std::string& folder);

}  // namespace plab::study
