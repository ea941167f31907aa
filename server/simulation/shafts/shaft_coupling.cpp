#include "simulation/shafts/shaft_coupling.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace plab::simulation
{

void ShaftCoupling::begin_level(Level level, const ConstraintGraph& graph, const Shafts& shafts)
{
    graph_ = &graph, shafts_ = &shafts, level_ = level;
    ++solve_;
    current_ = kNoIndex, largest_change_ = 0;
    conflict_.reset();
    participants_.clear();
}

void ShaftCoupling::configure(std::span<const std::uint32_t> members, std::span<const std::uint32_t> prescribed)
{
    index_.clear(), components_.clear(), shares_.clear(), participants_.clear();
    std::vector<std::uint32_t> rows(members.begin(), members.end());
    rows.insert(rows.end(), prescribed.begin(), prescribed.end());
    std::sort(rows.begin(), rows.end());
    for (const std::uint32_t row : rows) index_.add(row);
    members_.assign(index_.members().size(), {}), roots_.assign(index_.members().size(), {});
}

double ShaftCoupling::inertia_of(std::uint32_t root) const
{
    if (const ShaftTree* tree = graph_->tree_of(root)) return tree->inertia;
    return shafts_->dynamic(root) ? shafts_->inertia[root] : 0.0;
}

ShaftCoupling::Root& ShaftCoupling::enter(std::uint32_t root, double rate)
{
    const std::uint32_t i = takes_part(root) ? index_.find(root) : take_in(root, 0);
    Root& r = roots_[i];
    if (r.solve == solve_) return r;
    r.solve = solve_, r.sweep = 0, r.driver = r.driven = kNoIndex, r.touched = false;
    r.rate = rate, r.scale = std::fabs(rate), r.torque = 0;
    r.inertia = inertia_of(root);
    r.mobility = shafts_->dynamic(root) ? 1.0 / r.inertia : 0.0;
    return r;
}

std::uint32_t ShaftCoupling::take_in(std::uint32_t shaft, double torque)
{
    const std::uint32_t i = index_.add(shaft);
    if (i == members_.size()) members_.emplace_back(), roots_.emplace_back();
    members_[i] = {solve_, torque};
    return i;
}

void ShaftCoupling::begin_accelerations(const ConstraintGraph& graph, const Shafts& shafts, std::span<const double> torque,
                                        std::span<const std::uint32_t> members, std::span<const std::uint32_t> prescribed)
{
    begin_level(Level::Acceleration, graph, shafts);
    dynamic_ = members;
    for (const std::uint32_t i : prescribed) take_in(i, 0), enter(shafts.root[i], 0);  // forces do not affect it
    for (const std::uint32_t i : members)
    {
        take_in(i, torque[i]);
        enter(shafts.root[i], 0).torque += shafts.ratio[i] * torque[i];
    }
    for (const std::uint32_t i : members)
    {
        if (shafts.root[i] != i) continue;
        Root& r = *entered(i);
        r.rate = r.torque / r.inertia;
        r.scale = std::fabs(r.rate);
    }
}

void ShaftCoupling::begin_speeds(const ConstraintGraph& graph, const Shafts& shafts, std::span<const std::uint32_t> members,
                                 std::span<const std::uint32_t> prescribed)
{
    begin_level(Level::Speed, graph, shafts);
    dynamic_ = members;
    for (const auto list : {prescribed, members})
        for (const std::uint32_t i : list)
        {
            take_in(i, 0);
            enter(shafts.root[i], shafts.speed[shafts.root[i]]);
        }
}

void ShaftCoupling::start_sweep()
{
    ++sweep_, next_ = 0;
    largest_change_ = 0;
    conflict_.reset();
}

void ShaftCoupling::begin(std::uint32_t component, Ref driven)
{
    current_ = component;
    // Each sweep calls the same components in the same order, so most need no search.
    const auto known = components_.members();
    const std::uint32_t i = next_ < known.size() && known[next_] == component ? next_ : components_.add(component);
    if (i == shares_.size()) shares_.emplace_back();
    current_share_ = i, next_ = i + 1;
    Share& share = shares_[i];
    if (share.solve == solve_) return;
    share = {solve_, driven.index, 0, 0};
    participants_.push_back(component);
}

double ShaftCoupling::rate(Ref shaft) const
{
    if (const Root* r = entered(root_of(shaft))) return shafts_->ratio[shaft.index] * r->rate;
    return level_ == Level::Speed ? shafts_->speed[shaft.index] : 0.0;
}

double ShaftCoupling::scale(Ref shaft) const
{
    const Root* r = entered(root_of(shaft));
    return r ? std::fabs(shafts_->ratio[shaft.index]) * r->scale : 0.0;
}

double ShaftCoupling::mobility(Ref shaft) const
{
    const Root* r = entered(root_of(shaft));
    if (!r || assigned(*r)) return 0;
    const double ratio = shafts_->ratio[shaft.index];
    return ratio * ratio * r->mobility;
}

void ShaftCoupling::change_rate(Root& r, double rate)
{
    const double change = std::fabs(rate - r.rate);
    r.touched = r.touched || rate != r.rate;
    r.scale = std::max({r.scale, std::fabs(rate), std::fabs(r.rate)});
    r.rate = rate;
    if (change == 0) return;
    const double relative = change / r.scale;
    // A rate that is not a number counts as not converged.
    largest_change_ = std::max(largest_change_, std::isfinite(relative) ? relative : std::numeric_limits<double>::infinity());
}

void ShaftCoupling::apply(Ref shaft, double torque)
{
    assert(current_ != kNoIndex);
    const std::uint32_t i = shaft.index;
    const double ratio = shafts_->ratio[i];
    Share& share = shares_[current_share_];
    if (i == share.driven) share.reaction += torque;
    const std::uint32_t root = root_of(shaft), at = index_.find(root);
    if (at == kNoIndex || roots_[at].solve != solve_) return;  // not advanced here, so torques do not change it
    Root& r = roots_[at];
    members_[root == i ? at : index_.find(i)].torque += torque;
    r.torque += ratio * torque;

    const double before = r.rate;
    if (!assigned(r)) change_rate(r, r.rate + ratio * torque * r.mobility);
    if (level_ == Level::Acceleration)
    {
        if (shafts_->dynamic(i)) share.work += torque * shafts_->speed[i];
        return;
    }
    // Summed over the sweeps this is the change of kinetic energy. The work done on a driven shaft is taken up by its drive.
    const double work = 0.5 * ratio * torque * (before + r.rate);
    if (r.mobility > 0) share.work += work;
    if (assigned(r)) share_of(r.driver).work -= work;
}

void ShaftCoupling::assign(Ref shaft, double rate)
{
    assert(current_ != kNoIndex);
    const std::uint32_t i = shaft.index;
    const double ratio = shafts_->ratio[i];
    const std::uint32_t root = root_of(shaft);
    Root& r = enter(root, level_ == Level::Speed ? shafts_->speed[root] : 0.0);
    const double root_rate = rate / ratio;
    if (r.sweep == sweep_)
    {
        if (std::fabs(root_rate - r.rate) > kDriveTolerance * r.scale)
            conflict_ = DriveConflict{r.driver, current_, i, ratio * r.rate, rate};
        return;
    }
    r.sweep = sweep_, r.driver = current_, r.driven = i;
    if (level_ == Level::Speed) shares_[current_share_].work += 0.5 * r.inertia * (root_rate - r.rate) * (root_rate + r.rate);
    change_rate(r, root_rate);
}

void ShaftCoupling::store_speeds(Shafts& shafts) const
{
    assert(level_ == Level::Speed);
    for (const std::uint32_t i : dynamic_)
        if (const Root& r = *entered(shafts.root[i]); r.touched) shafts.speed[i] = shafts.ratio[i] * r.rate;
}

double ShaftCoupling::total_torque(std::uint32_t shaft) const
{
    if (!takes_part(shaft)) return 0;
    const Root& r = *entered(shafts_->root[shaft]);
    const double torque = members_[index_.find(shaft)].torque;
    if (assigned(r)) return torque + (r.driven == shaft ? holding_torque(r) / shafts_->ratio[shaft] : 0.0);
    return shafts_->dynamic(shaft) ? torque : torque + holding_torque(r);
}

double ShaftCoupling::reaction(std::uint32_t component) const
{
    const Share& share = share_of(component);
    const Root* r = entered(shafts_->root[share.driven]);
    const bool drives = r && r->driver == component;
    return drives ? share.reaction + holding_torque(*r) / shafts_->ratio[share.driven] : share.reaction;
}

void ShaftCoupling::account(std::vector<double>& work, double share)
{
    for (const std::uint32_t c : participants_)
    {
        double done = share_of(c).work;
        const std::uint32_t root = shafts_->root[share_of(c).driven];
        if (const Root* r = entered(root); level_ == Level::Acceleration && r && r->driver == c && shafts_->dynamic(root))
            done += holding_torque(*r) * shafts_->speed[root];
        work[c] += share * done;
    }
    if (level_ != Level::Acceleration) return;
    for_each_tree(
        [&](const ShaftTree& tree)
        {
            if (tree.prescribed) account_prescribed(tree, work, share);
        });
}

// Power through each coupling of the prescribed shaft: (a sum rho^2 J - sum rho tau) w over the subtree, a and w being those of the root.
void ShaftCoupling::account_prescribed(const ShaftTree& tree, std::vector<double>& work, double share)
{
    const auto nodes = graph_->nodes(tree);
    const Root& r = *entered(tree.root);
    below_.resize(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
        const std::uint32_t shaft = nodes[k].shaft;
        below_[k] = takes_part(shaft) ? nodes[k].ratio * members_[index_.find(shaft)].torque : 0.0;
    }
    for (std::size_t k = nodes.size(); --k > 0;)
    {
        const ShaftNode& n = nodes[k];
        if (n.parent != tree.first)
            below_[n.parent - tree.first] += below_[k];
        else
            work[n.component] += share * (n.inertia_inside * r.rate - below_[k]) * shafts_->speed[tree.root];
    }
}

}  // namespace plab::simulation
