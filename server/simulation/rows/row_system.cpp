#include "simulation/rows/row_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plab/row_speed.h"
#include "simulation/rows/scheduled_rows.h"

namespace plab::simulation
{
namespace
{

/// Largest change of speed that rows may cause in one step, as a multiple of the present speed and of what the loads add. A rotation by 4
/// rad in a step is beyond any solver.
constexpr double kMostKick = 4;

}  // namespace

/// Runs the components' Constrain commands.
class RowSystem::RowsOfComponents final : public RowSource
{
public:
    void select(world::World& world, const Schedule& schedule, std::span<const BlockRow> rows)
    {
        scheduled_.select(world, schedule, Phase::Constrain, rows);
    }
    void constrain(const StepContext& context, RowSink& sink) override { scheduled_.run(context, sink, nullptr); }

private:
    ScheduledRows scheduled_;
};

/// Receives the rows: groups them into pieces by component, and replaces shafts by the roots of their trains.
class RowSystem::Sink final : public RowSink
{
public:
    explicit Sink(RowSystem& out) : out_(out), shafts_(out.host_->shafts) {}
    void begin(std::uint32_t component) override { component_ = component, fresh_ = true; }
    void add(const ConstraintRow& row) override
    {
        const auto at = static_cast<std::uint32_t>(out_.rows_.size());
        if (std::exchange(fresh_, false)) out_.pieces_.push_back({component_, at, 0});
        ++out_.pieces_.back().count;
        ConstraintRow& mine = out_.rows_.emplace_back(row);
        mine.component = component_, mine.impulse = 0;
        for (std::uint32_t k = 0; k < mine.count; ++k) reduce(mine.blocks[k], at, k);
        if (mine.may_yield()) out_.may_yield_ = true;
    }

private:
    void reduce(RowBlock& block, std::uint32_t row, std::uint32_t k)
    {
        const RowBlock as_given = block;
        if (replace_by_root(block, shafts_)) out_.geared_.push_back({row, k, as_given.participant, as_given.angular.x});
    }

    RowSystem& out_;
    const Shafts& shafts_;
    std::uint32_t component_ = kNoIndex;
    bool fresh_ = true;
};

RowSystem::RowSystem() = default;
RowSystem::~RowSystem() = default;
RowSystem::RowSystem(RowSystem&&) noexcept = default;
RowSystem& RowSystem::operator=(RowSystem&&) noexcept = default;

void RowSystem::configure(world::World& world, const Schedule& schedule, std::span<const BlockRow> rows, const ConstraintGraph& graph)
{
    if (rows.empty())
    {
        source_ = nullptr;
        return;
    }
    if (!scheduled_) scheduled_ = std::make_unique<RowsOfComponents>();
    scheduled_->select(world, schedule, rows);
    configure(world.host(), *scheduled_, graph);
}

void RowSystem::configure(world::HostTables& host, RowSource& source, const ConstraintGraph& graph)
{
    host_ = &host, source_ = &source, graph_ = &graph;
    equations_.bind(host, graph);
    equations_.forget_implied();
    rows_.clear(), geared_.clear(), pieces_.clear(), lambda_.clear();
    position_error_.clear(), speed_error_.clear(), redundant_.clear();
    may_yield_ = factored_ = false;
}

void RowSystem::collect(const StepContext& context)
{
    rows_.clear(), geared_.clear(), pieces_.clear();
    may_yield_ = false;
    Sink sink(*this);
    source_->constrain(context, sink);
}

bool RowSystem::is_mobile(Ref participant) const
{
    return participant.facet == Facet::Body ? host_->bodies.dynamic(participant.index) : host_->shafts.dynamic(participant.index);
}

double RowSystem::speed_of(const RowBlock& b) const { return plab::speed_of(b, host_->bodies, host_->shafts); }

double RowSystem::speed_of(const ConstraintRow& row) const { return plab::speed_of(row, host_->bodies, host_->shafts); }

double RowSystem::speed_of_others(const ConstraintRow& row) const
{
    double sum = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
        if (!is_mobile(row.blocks[k].participant)) sum += speed_of(row.blocks[k]);
    return sum;
}

void RowSystem::load_forces(const Wrenches& wrenches)
{
    const Bodies& bodies = host_->bodies;
    const auto members = equations_.members();
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        double* g = equations_.load(i);
        const std::uint32_t index = members[i].participant.index;
        if (members[i].participant.facet == Facet::Body)
        {
            const Quat& q = bodies.orientation[index];
            const Vec3 w_B = rotate_back(q, bodies.angular_velocity[index]);
            const Vec3 torque_B = rotate_back(q, wrenches.torque[index]) - cross(w_B, bodies.inertia_B[index] * w_B);
            const Vec3& f = wrenches.force[index];
            g[0] = f.x, g[1] = f.y, g[2] = f.z, g[3] = torque_B.x, g[4] = torque_B.y, g[5] = torque_B.z;
            continue;
        }
        const ShaftTree* tree = graph_->tree_of(index);
        if (!tree)
            g[0] = wrenches.shaft_torque[index];
        else
            for (const ShaftNode& node : graph_->nodes(*tree)) g[0] += node.ratio * wrenches.shaft_torque[node.shaft];
    }
}

bool RowSystem::react(const StepContext& context, Wrenches& wrenches)
{
    collect(context);
    factored_ = false;
    equations_.set_rows(rows_, pieces_);
    lambda_.assign(rows_.size(), 0.0);
    const auto slots = equations_.slots();
    if (slots.empty()) return true;
    equations_.factor();
    equations_.clear_right_hand_side();
    load_forces(wrenches);
    for (std::size_t s = 0; s < slots.size(); ++s) equations_.wanted(s) = rows_[slots[s].row].bias;
    bool finite = equations_.solve_refined();
    if (finite && equations_.compliant()) equations_.sharpen();
    finite = finite && (!equations_.compliant() || regularize_near_singular(context.dt));
    if (finite)
    {
        for (std::size_t s = 0; s < slots.size(); ++s) lambda_[slots[s].row] = equations_.multiplier(s);
        add_reactions(wrenches);
    }
    return finite;
}

/// Close to a singular configuration, speeds that do not fit it require accelerations of the order v^2 / angle: a linkage that is fully
/// stretched cannot move on. Where a step of this length cannot resolve that, the compliance is increased until it can.
bool RowSystem::regularize_near_singular(double dt)
{
    const double speed = speed_norm();
    RowEquations::Norms norms = equations_.norms();
    const double most = speed + dt * norms.loads;
    if (!(dt * norms.reactions > kMostKick * most)) return true;
    for (double compliance = 100 * RowEquations::kCompliance; compliance < 1; compliance *= 100)
    {
        equations_.factor(compliance);
        if (!equations_.solve()) return false;
        norms = equations_.norms();
        if (dt * norms.reactions < most) break;
    }
    return true;
}

/// sqrt(v . M v) of the members.
double RowSystem::speed_norm() const
{
    double sum = 0;
    for (const RowEquations::Member& m : equations_.members())
        sum += m.participant.facet == Facet::Body
                   ? 2 * host_->bodies.kinetic_energy(m.participant.index)
                   : m.inertia * host_->shafts.speed[m.participant.index] * host_->shafts.speed[m.participant.index];
    return std::sqrt(sum);
}

void RowSystem::add_reactions(Wrenches& wrenches) const
{
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < rows_.size(); ++i)
        for (std::uint32_t k = 0; k < rows_[i].count; ++k)
        {
            const RowBlock& b = rows_[i].blocks[k];
            const bool geared = next < geared_.size() && geared_[next].row == i && geared_[next].block == k;
            const Geared* as_given = geared ? &geared_[next++] : nullptr;
            if (!is_mobile(b.participant)) continue;
            if (b.participant.facet == Facet::Body)
                wrenches.force[b.participant.index] += b.linear * lambda_[i],
                    wrenches.torque[b.participant.index] += b.angular * lambda_[i];
            else if (as_given)
                wrenches.shaft_torque[as_given->participant.index] += as_given->coefficient * lambda_[i];
            else
                wrenches.shaft_torque[b.participant.index] += b.angular.x * lambda_[i];
        }
}

/// Whether a row's work is booked: rows join members of one group, so the first dynamic participant decides.
bool RowSystem::books(const ConstraintRow& row, const RowBook& book) const
{
    const auto end = row.blocks.begin() + row.count;
    const auto moved = std::find_if(row.blocks.begin(), end, [&](const RowBlock& b) { return is_mobile(b.participant); });
    if (moved == end) return false;
    const auto& flags = moved->participant.facet == Facet::Body ? book.bodies : book.shafts;
    return flags.empty() || flags[moved->participant.index] != 0;
}

void RowSystem::account(const RowBook& book, double share) const
{
    for (std::uint32_t i = 0; i < rows_.size() && i < lambda_.size(); ++i)
    {
        const ConstraintRow& row = rows_[i];
        if (lambda_[i] == 0 || !books(row, book)) continue;
        (*book.work)[row.component] += book.sign * share * lambda_[i] * (row.rate - speed_of_others(row));
    }
}

void RowSystem::begin_hold(const StepContext& context, std::span<const ConstraintRow> further)
{
    collect(context);
    held_speed_.clear();
    for (const std::span<const ConstraintRow> some : {std::span<const ConstraintRow>(rows_), further})
        for (const ConstraintRow& row : some) held_speed_.push_back(speed_of(row) - speed_of_others(row));
}

double RowSystem::take_impulses(const StepContext& context, std::span<const ConstraintRow> held, double h, const RowBook& book)
{
    collect(context);
    lambda_.assign(rows_.size(), 0.0);
    position_error_.assign(rows_.size(), 0.0), speed_error_.assign(rows_.size(), 0.0);
    redundant_.assign(pieces_.size(), 0);
    double sum = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
        const ConstraintRow& row = rows_[i];
        if (row.kind == RowKind::Equality) position_error_[i] = row.error;
        if (row.kind == RowKind::OneSided) position_error_[i] = std::fmin(0.0, row.error);
        if (!row.may_yield()) speed_error_[i] = speed_of(row) - row.rate;
        // A limit may have become active or inactive since; both lists are in the same order, so one pass finds the pairs.
        std::size_t found = at;
        while (found < held.size() && !(held[found].component == row.component && held[found].feature == row.feature)) ++found;
        if (found == held.size()) continue;
        // A stop from which its body has rebounded is not among the rows any more.
        for (; at < found; ++at) sum += book_work(held[at], at, held[at], book);
        at = found + 1;
        lambda_[i] = held[found].impulse / h;
        sum += book_work(held[found], found, row, book);
    }
    for (; at < held.size(); ++at) sum += book_work(held[at], at, held[at], book);
    keep_reactions();
    return sum;
}

/// J: what a row did that a manager held, at the mean of its speeds before and after; `now` is the row at the end of the step.
double RowSystem::book_work(const ConstraintRow& held, std::size_t place, const ConstraintRow& now, const RowBook& book)
{
    if (!book.work || held.impulse == 0 || !books(now, book)) return 0;
    const double work = 0.5 * held.impulse * (held_speed_[place] + speed_of(now) - speed_of_others(now));
    (*book.work)[now.component] += book.sign * work;
    return work;
}

void RowSystem::keep_reactions()
{
    reactions_.clear();
    for (const RowPiece& piece : pieces_)
    {
        Reaction r;
        r.component = piece.component;
        const ConstraintRow& first = rows_[piece.first];
        const std::uint32_t last = first.count - 1;
        for (std::uint32_t i = piece.first; i < piece.first + piece.count && i < lambda_.size(); ++i)
        {
            const RowBlock& b = rows_[i].blocks[rows_[i].count - 1];
            if (b.participant != first.blocks[last].participant) continue;
            r.force += b.linear * lambda_[i], r.torque += b.angular * lambda_[i];
        }
        // Report the torque on the shaft itself, not on the root of its train.
        const auto geared =
            std::find_if(geared_.begin(), geared_.end(), [&](const Geared& g) { return g.row == piece.first && g.block == last; });
        if (geared != geared_.end() && geared->coefficient != 0) r.torque.x *= geared->coefficient / first.blocks[last].angular.x;
        reactions_.push_back(r);
    }
}

void RowSystem::report_to(RowReportTable& table) const
{
    for (const Reaction& r : reactions_) table.at(r.component).force = r.force, table.at(r.component).torque = r.torque;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
    {
        RowReport& report = table.at(pieces_[p].component);
        for (std::uint32_t i = pieces_[p].first; i < pieces_[p].first + pieces_[p].count; ++i)
        {
            if (i < position_error_.size()) report.position_error = std::fmax(report.position_error, std::fabs(position_error_[i]));
            if (i < speed_error_.size()) report.speed_error = std::fmax(report.speed_error, std::fabs(speed_error_[i]));
        }
        if (p < redundant_.size()) report.redundant = redundant_[p];
    }
}

}  // namespace plab::simulation
