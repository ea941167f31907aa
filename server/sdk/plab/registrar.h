/// How a plugin declares its component types: one call per type, with commands bound to plain functions.
///
/// A command is a free function whose signature states what it reads (const X&) and writes (X&); the registrar derives the call and the
/// table of accesses from it. A function takes `Rows` (all rows of the phase, in id order) or one `Row`.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "plab/collision.h"
#include "plab/collision_filter.h"
#include "plab/context.h"
#include "plab/dynamics.h"
#include "plab/island.h"
#include "plab/levels.h"
#include "plab/picture.h"
#include "plab/result.h"
#include "plab/rows.h"
#include "plab/schema.h"
#include "plab/shafts.h"
#include "plab/stage.h"
#include "plab/tables.h"
#include "plab/wrenches.h"

namespace plab
{

/// The rows of one component type in one world.
class TableBase
{
public:
    virtual ~TableBase() = default;
    virtual void describe(Schema& schema) = 0;
    virtual void* rows() = 0;
};

template <class T>
class TableOf final : public TableBase
{
public:
    void describe(Schema& schema) override { rows_.describe(schema); }
    void* rows() override { return &rows_; }

private:
    T rows_;
};

/// Receives what a component stores, part by part: the energy (J) of one object, or of two that share it. `b` may be no object.
class StoredEnergySink
{
public:
    virtual ~StoredEnergySink() = default;
    virtual void add(double joule, Ref a, Ref b) = 0;
};

/// Output of Phase::Potential: the energy that a component stores in the present state.
struct StoredEnergy
{
    double joule = 0;                  ///< of all of it
    StoredEnergySink* sink = nullptr;  ///< null: nobody asks whose it is

    /// Energy that one object has in a field, or that two share. What is added to `joule` by other means belongs to nobody: bounds in W
    /// cannot be checked for it (plab-study --verify-levels).
    void add(double more, Ref a, Ref b = {})
    {
        joule += more;
        if (sink) sink->add(more, a, b);
    }
};

/// Everything that a command may ask for. The host fills what the phase provides; the rest is null.
struct PhaseCall
{
    const StepContext* context = nullptr;
    Rows rows;
    Bodies* bodies = nullptr;
    Shafts* shafts = nullptr;
    Quantities* quantities = nullptr;
    Shapes* shapes = nullptr;
    Materials* materials = nullptr;
    CollisionFilter* filter = nullptr;
    Wrenches* wrenches = nullptr;               // Force
    ShaftMotion* shaft_motion = nullptr;        // Couple
    RatioGraph* ratios = nullptr;               // Connect
    const ShaftReactions* reactions = nullptr;  // Finish
    RowSink* rows_out = nullptr;                // Constrain, Linearize
    const RowReports* row_reports = nullptr;    // Finish
    DynamicSystem* system = nullptr;            // Advance
    Island* island = nullptr;                   // Solve: one of them
    std::span<Island> islands;                  // Solve
    GapQuery* gap = nullptr;                    // Gap
    ContactSink* contacts = nullptr;            // Detect
    EventBracket* trial = nullptr;              // Locate
    ContactLoad* load = nullptr;                // Choose
    Impact* impact = nullptr;                   // Respond, Touch
    Touches* touches = nullptr;                 // Finish
    MassProperties* solid = nullptr;            // Measure
    StoredEnergy* stored = nullptr;             // Potential
    ViewpointSink* viewpoints = nullptr;        // View
    LevelControl* levels = nullptr;             // Decide
    RequestSink* requests = nullptr;            // Decide
    const RenderScene* render_scene = nullptr;  // Draw
    ImageSink* images = nullptr;                // Draw
};

using Thunk = Result<void> (*)(const PhaseCall& call, void* table);

struct Access
{
    std::string table;  ///< "Bodies", "Wrenches", ...
    bool writes = false;
};

struct CommandInfo
{
    std::string name;  ///< as in blueprints: "CDetection/Handle"
    Phase phase = Phase::Finish;
    std::string doc;
    Thunk run = nullptr;
    std::vector<Access> access;
};

/// A component type as its plugin declares it.
struct TypeInfo
{
    std::string name;
    std::string doc;
    std::string family;  ///< types of one family can be swapped for one another; the name without its last part unless stated
    Facet facet = Facet::Component;
    std::unique_ptr<TableBase> (*make)() = nullptr;
    std::vector<CommandInfo> commands;

    // Properties for listings and for choosing an algorithm.
    int order = 0;             ///< order of convergence, if the type has one
    bool elementwise = false;  ///< solver: groups may be advanced together without changing a bit
    bool local = false;        ///< resolution: rewinds only the group concerned, not the whole world
    bool locates = false;      ///< resolution: finds the time of an event inside the step
    bool certifies = false;    ///< resolution: searches inside the step for events that its two ends do not show
    bool adapts = false;       ///< resolution: chooses in each step whether it locates, speculates or does neither (Phase::Choose)
    bool speculates = false;   ///< resolution: gaps that may close within the step become rows
    bool by_rows = false;      ///< response: contacts are rows solved by a manager, including impacts
    bool by_force = false;     ///< response: contacts are forces, evaluated at every solver stage
    bool uniform = false;      ///< force: independent of time and state
    /// manager: the largest number of contact points of an island whose pivots (plab/collision.h) it puts midway
    std::size_t pivots_up_to = 0;
    std::string accuracy;   ///< in addition to `order`: "times of impact to one step"
    std::string strengths;  ///< for which scenes it is suited
    std::string cost;       ///< for example "4 force evaluations per step"
    std::string limits;     ///< where it fails
    std::string source;     ///< paper or book, with the equation
};

namespace detail
{
template <class A, class Table>
struct Argument;

#define PLAB_ARGUMENT(Type, member, label)                                                                                      \
    template <class Table>                                                                                                      \
    struct Argument<Type, Table>                                                                                                \
    {                                                                                                                           \
        static Type get(const PhaseCall& c, Table&, Row) { return *c.member; }                                                  \
        static void note(std::vector<Access>& out) { out.push_back({label, !std::is_const_v<std::remove_reference_t<Type>>}); } \
    }
PLAB_ARGUMENT(const StepContext&, context, "StepContext");
PLAB_ARGUMENT(Bodies&, bodies, "Bodies");
PLAB_ARGUMENT(const Bodies&, bodies, "Bodies");
PLAB_ARGUMENT(Shafts&, shafts, "Shafts");
PLAB_ARGUMENT(const Shafts&, shafts, "Shafts");
PLAB_ARGUMENT(Quantities&, quantities, "Quantities");
PLAB_ARGUMENT(const Quantities&, quantities, "Quantities");
PLAB_ARGUMENT(Shapes&, shapes, "Shapes");
PLAB_ARGUMENT(const Shapes&, shapes, "Shapes");
PLAB_ARGUMENT(Materials&, materials, "Materials");
PLAB_ARGUMENT(CollisionFilter&, filter, "CollisionFilter");
PLAB_ARGUMENT(const CollisionFilter&, filter, "CollisionFilter");
PLAB_ARGUMENT(Wrenches&, wrenches, "Wrenches");
PLAB_ARGUMENT(ShaftMotion&, shaft_motion, "ShaftMotion");
PLAB_ARGUMENT(RatioGraph&, ratios, "RatioGraph");
PLAB_ARGUMENT(const ShaftReactions&, reactions, "ShaftReactions");
PLAB_ARGUMENT(RowSink&, rows_out, "Rows");
PLAB_ARGUMENT(const RowReports&, row_reports, "RowReports");
PLAB_ARGUMENT(DynamicSystem&, system, "DynamicSystem");
PLAB_ARGUMENT(Island&, island, "Island");
PLAB_ARGUMENT(GapQuery&, gap, "Gap");
PLAB_ARGUMENT(ContactSink&, contacts, "Contacts");
PLAB_ARGUMENT(EventBracket&, trial, "EventBracket");
PLAB_ARGUMENT(ContactLoad&, load, "ContactLoad");
PLAB_ARGUMENT(Impact&, impact, "Impact");
PLAB_ARGUMENT(Touches&, touches, "Touches");
PLAB_ARGUMENT(const Touches&, touches, "Touches");
PLAB_ARGUMENT(MassProperties&, solid, "MassProperties");
PLAB_ARGUMENT(StoredEnergy&, stored, "StoredEnergy");
PLAB_ARGUMENT(ViewpointSink&, viewpoints, "Viewpoints");
PLAB_ARGUMENT(LevelControl&, levels, "Levels");
PLAB_ARGUMENT(RequestSink&, requests, "Requests");
PLAB_ARGUMENT(const RenderScene&, render_scene, "RenderScene");
PLAB_ARGUMENT(ImageSink&, images, "Images");
#undef PLAB_ARGUMENT

template <class Table>
struct Argument<Rows, Table>
{
    static Rows get(const PhaseCall& c, Table&, Row) { return c.rows; }
    static void note(std::vector<Access>&) {}
};
template <class Table>
struct Argument<Row, Table>
{
    static Row get(const PhaseCall&, Table&, Row row) { return row; }
    static void note(std::vector<Access>&) {}
};
template <class Table>
struct Argument<Table&, Table>
{
    static Table& get(const PhaseCall&, Table& t, Row) { return t; }
    static void note(std::vector<Access>& out) { out.push_back({"own", true}); }
};
template <class Table>
struct Argument<const Table&, Table>
{
    static const Table& get(const PhaseCall&, Table& t, Row) { return t; }
    static void note(std::vector<Access>& out) { out.push_back({"own", false}); }
};

/// A command that takes an Island& is called once for each island, one that takes this once for all of them.
template <class Table>
struct Argument<std::span<Island>, Table>
{
    static std::span<Island> get(const PhaseCall& c, Table&, Row) { return c.islands; }
    static void note(std::vector<Access>& out) { out.push_back({"Island", true}); }
};

template <auto F, class Table, class R, class... A>
struct Command
{
    static constexpr bool kPerRow = (std::is_same_v<A, Row> || ...), kPerIsland = (std::is_same_v<A, Island&> || ...);

    static Result<void> once(const PhaseCall& call, Table& table, Row row)
    {
        if constexpr (std::is_void_v<R>)
        {
            F(Argument<A, Table>::get(call, table, row)...);
            return {};
        }
        else
            return F(Argument<A, Table>::get(call, table, row)...);
    }
    static Result<void> of_rows(const PhaseCall& call, Table& table)
    {
        if constexpr (!kPerRow) return once(call, table, kNoIndex);
        for (const Row row : call.rows)
            if (auto r = once(call, table, row); !r) return r;
        return {};
    }
    static Result<void> run(const PhaseCall& call, void* rows)
    {
        Table& table = *static_cast<Table*>(rows);
        if (!kPerIsland || call.islands.empty()) return of_rows(call, table);
        PhaseCall one = call;
        for (Island& island : call.islands)
        {
            if (island.interrupted()) break;
            one.island = &island;
            if (auto r = of_rows(one, table); !r) return r;
        }
        return {};
    }
    static std::vector<Access> access()
    {
        std::vector<Access> out;
        (Argument<A, Table>::note(out), ...);
        return out;
    }
};

template <auto F, class Table, class Signature = decltype(F)>
struct CommandOf;
template <auto F, class Table, class R, class... A>
struct CommandOf<F, Table, R (*)(A...)> : Command<F, Table, R, A...>
{
};
}  // namespace detail

/// Adds commands and properties to the type that was just declared.
template <class Table>
class TypeBuilder
{
public:
    explicit TypeBuilder(TypeInfo& info) : info_(&info) {}

    template <auto F>
    TypeBuilder& command(Phase phase, std::string name, std::string doc)
    {
        using C = detail::CommandOf<F, Table>;
        info_->commands.push_back({std::move(name), phase, std::move(doc), &C::run, C::access()});
        return *this;
    }
    /// A command that the host itself carries out (such as State/Restore); it is listed so that scenes can name it.
    TypeBuilder& host_command(Phase phase, std::string name, std::string doc)
    {
        info_->commands.push_back({std::move(name), phase, std::move(doc), nullptr, {}});
        return *this;
    }
    TypeBuilder& facet(Facet f) { return info_->facet = f, *this; }
    TypeBuilder& family(std::string name) { return info_->family = std::move(name), *this; }
    TypeBuilder& order(int p) { return info_->order = p, *this; }
    TypeBuilder& elementwise() { return info_->elementwise = true, *this; }
    TypeBuilder& local() { return info_->local = true, *this; }
    TypeBuilder& locates() { return info_->locates = true, *this; }
    TypeBuilder& certifies() { return info_->certifies = true, *this; }
    TypeBuilder& adapts() { return info_->adapts = true, *this; }
    TypeBuilder& speculates() { return info_->speculates = true, *this; }
    TypeBuilder& by_rows() { return info_->by_rows = true, *this; }
    TypeBuilder& by_force() { return info_->by_force = true, *this; }
    TypeBuilder& uniform() { return info_->uniform = true, *this; }
    TypeBuilder& pivots_up_to(std::size_t points) { return info_->pivots_up_to = points, *this; }
    TypeBuilder& accuracy(std::string text) { return info_->accuracy = std::move(text), *this; }
    TypeBuilder& strengths(std::string text) { return info_->strengths = std::move(text), *this; }
    TypeBuilder& cost(std::string text) { return info_->cost = std::move(text), *this; }
    TypeBuilder& limits(std::string text) { return info_->limits = std::move(text), *this; }
    TypeBuilder& source(std::string text) { return info_->source = std::move(text), *this; }

private:
    TypeInfo* info_;
};

/// Collects the types of one plugin.
class Registrar
{
public:
    template <class Table>
    TypeBuilder<Table> component(std::string name, std::string doc)
    {
        TypeInfo& t = types_.emplace_back();
        t.name = std::move(name), t.doc = std::move(doc);
        t.family = t.name.substr(0, t.name.rfind('/'));
        t.make = [] { return std::unique_ptr<TableBase>(std::make_unique<TableOf<Table>>()); };
        return TypeBuilder<Table>(t);
    }
    std::deque<TypeInfo>& types() { return types_; }

private:
    std::deque<TypeInfo> types_;
};

}  // namespace plab
