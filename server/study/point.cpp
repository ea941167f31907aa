// Figures of one run, and how a reference is asked for.
#include <algorithm>
#include <cmath>

#include "study/study.h"

namespace plab::study
{
namespace
{

/// The largest; NaN if one is.
double worst(const std::vector<Distance>& errors, double Distance::*which)
{
    double out = errors.empty() ? kNaN : 0;
    for (const Distance& e : errors) out = e.*which > out || std::isnan(e.*which) ? e.*which : out;
    return out;
}

}  // namespace

ReferencePlan parse_reference(const std::string& text)
{
    ReferencePlan out;
    if (text == "auto") return out;
    if (text == "none") return out.kind = ReferencePlan::Kind::None, out;
    out.kind = text.starts_with("exact:") ? ReferencePlan::Kind::Exact : ReferencePlan::Kind::File;
    out.text = text.starts_with("exact:") ? text.substr(6) : text;
    return out;
}

double Point::error() const { return worst(errors, &Distance::series); }
double Point::final_error() const { return worst(errors, &Distance::last); }
bool Point::is_resolved() const
{
    return std::any_of(resolved.begin(), resolved.end(), [](bool b) { return b; });
}

double digits(double error) { return std::isnan(error) ? kNaN : std::clamp(-std::log10(error), 0.0, 16.0); }

}  // namespace plab::study
