/// The reference of a study: a closed form, a file, or the finest algorithm, extrapolated.
#pragma once

#include "study/run.h"

namespace plab::study
{

/// The best known solution at the sample times.
struct Reference
{
    std::string kind;                     ///< "exact", "file", "auto", "none"
    std::string words;                    ///< description for people
    std::vector<double> times;            ///< s
    std::vector<TimeSeries> time_series;  ///< by quantity; NaN where unknown
    std::vector<double> scale;            ///< a of the mixed error, by quantity
    std::vector<Distance> uncertainty;    ///< by quantity; NaN: unknown
    std::vector<double> order;            ///< observed order of convergence by quantity; NaN: none could be observed
    std::vector<bool> converged;          ///< auto, by quantity: extrapolated, or equal to round-off
    bool converges = true;                ///< whether all of them did
    bool knows_contacts = false;
    std::vector<RecordedContact> contacts;
    std::string trouble;  ///< why there is none
};

Reference no_reference(std::size_t quantities, const std::string& why);

/// A closed form by name ("parabola", "oscillator:stiffness=100").
Result<Reference> exact_reference(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options,
                                  const std::string& text);

/// A CSV that plabd --trace or plab-study wrote: columns time, ID.field.x ... Rows are taken at the sample times.
Result<Reference> file_reference(const std::vector<Quantity>& quantities, const std::vector<double>& times, const std::string& path);

/// Three runs of one algorithm with dt, dt/2 and dt/4, extrapolated by Richardson:
///   p = log2(|y1 - y2| / |y2 - y4|),   y = y4 + (y4 - y2)/(2^p - 1)
/// with p rounded to a whole number if it is close to one. The uncertainty is the size of that correction. If the three agree
/// to round-off, nothing is extrapolated, and the uncertainty is their largest difference.
/// An order below 0.9 does not belong to any method: an event is located a step late, or the solution jumps, or is chaotic.
/// That counts as not converged: y4 is used unchanged, and the uncertainty is the rest of the series if it continued at that
/// order, |y2 - y4|/(2^p - 1), or the largest difference if that is larger. Below p = 0.2, nothing indicates that the series
/// continues like that: then the uncertainty is as large as for 0.2, of the largest difference.
Reference auto_reference(const std::vector<RunRecord>& coarse_to_fine, const std::string& algorithm, const std::string& dt);

}  // namespace plab::study
