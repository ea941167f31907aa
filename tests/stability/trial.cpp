#include "trial.h"

#include "support/load.h"

namespace plab::stability
{

namespace
{

/// The position in the generated text is left out.
std::string without_place(const std::string& message)
{
    const std::size_t end = message.find(": ");
    return message.rfind("case.xml", 0) == 0 && end != std::string::npos ? message.substr(end + 2) : message;
}

}  // namespace

Trial::Trial(const std::string& body, const std::string& settings, std::uint64_t most_evaluations) : most_evaluations_(most_evaluations)
{
    auto loaded = test::load_text(test::whole_scene(body, settings), "case.xml");
    if (loaded)
        simulation_ = std::move(*loaded);
    else
        refusal_ = without_place(loaded.error().text());
}

void Trial::step()
{
    simulation_->step();
    evaluations_ += std::max<std::uint64_t>(simulation_->stepper().report().evaluations, 1);
    for (const Event& e : simulation_->events())
    {
        ++counts_[e.kind];
        if (e.severity != Severity::Info) ++troubles_[e.kind];
    }
}

double Trial::real(const std::string& id, const std::string& field) const
{
    const auto& world = simulation_->world();
    return std::get<double>(world.get(world.find(id), field));
}
Vec3 Trial::vec(const std::string& id, const std::string& field) const
{
    const auto& world = simulation_->world();
    return std::get<Vec3>(world.get(world.find(id), field));
}
Quat Trial::quat(const std::string& id, const std::string& field) const
{
    const auto& world = simulation_->world();
    return std::get<Quat>(world.get(world.find(id), field));
}

std::size_t Trial::count(const std::string& kind) const
{
    const auto found = counts_.find(kind);
    return found == counts_.end() ? 0 : found->second;
}

/// An outcome with what was reported, and how far a slow cell came.
Outcome Trial::outcome(Verdict verdict, double error) const
{
    Outcome out{verdict, error, {}, {}};
    for (const auto& [kind, n] : troubles_) out.how += (out.how.empty() ? "" : ", ") + kind;
    if (!finished_) out.reached = 100 * simulation_->time() / until_;
    return out;
}

Outcome Trial::judge(double error, Bounds bounds) const
{
    if (refusal_.find(".so") != std::string::npos) return {Verdict::Silent, 0, "not run: a plugin is not there", {}};
    if (!loaded()) return {Verdict::Refused, 0, refusal_, {}};
    if (count("state.not_finite") > 0) return outcome(Verdict::Diverged, error);
    if (std::isfinite(error) && error <= bounds.bounded)
        return outcome(error <= bounds.stable && !warned() && finished_ ? Verdict::Stable : Verdict::Degraded, error);
    if (warned()) return outcome(Verdict::Diverged, error);
    // An informational event about this.
    if (count("manager.not_converged") > 0) return {Verdict::Diverged, error, "manager.not_converged", {}};
    return outcome(Verdict::Silent, error);
}

std::vector<std::string> algorithms_of(const std::string& family)
{
    std::vector<std::string> out;
    for (const std::string& name : test::library().names())
        if (name.rfind(family + "/", 0) == 0) out.push_back(name.substr(family.size() + 1));
    return out;
}

void load_plugins()
{
    for (const std::string& name : test::library().names()) (void)test::library().require(name);
}

}  // namespace plab::stability
