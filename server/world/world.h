/// The components of a scene at one time: tables, host tables, and the directory of ids.
///
/// The world knows no time and no phases; server/simulation steps it. Rows are created and removed only by add, exchange and remove,
/// which the simulation calls at step boundaries.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/scene.h"
#include "model/type_registry.h"
#include "world/host_tables.h"
#include "world/revisions.h"
#include "world/shared.h"
#include "world/table.h"
#include "world/undo_log.h"

namespace plab::world
{

/// The directory of components. Changed only by requests.
struct Directory
{
    std::vector<Component> components;
    Shared<std::map<std::string, std::uint32_t>> index_of_id;  ///< apart, because an exchange does not change it
    std::vector<std::uint32_t> free;
};

/// A row without a component, kept because a rollback may need it again.
struct Parked
{
    std::uint32_t table;
    Row row;
    std::uint32_t host_index;  ///< to be freed with the row, or kNoIndex
    Facet facet;
    friend bool operator==(const Parked&, const Parked&) = default;
};

/// What a rollback needs to restore everything except opaque objects, whose rows stay parked.
struct Backup
{
    Shared<Directory> directory;
    Shared<model::SceneSpec> scene;
    std::vector<Parked> parked;
    HostTables host;
    std::vector<std::uint8_t> cells;  ///< params, state and outputs of all rows, in directory order
};

struct Image;

class World
{
public:
    explicit World(model::TypeSource& types) : types_(&types) {}

    // Structure ------------------------------------------------------------------------------------------------------
    /// Adds all components of `fragment`; ids must be new. Binds roles and prepares rows. After an error the world is unusable until a
    /// backup is restored.
    Result<void> add(const model::SceneSpec& fragment);
    /// The same for a scene that was put together in advance: `whole` consists of the components that are here, followed by those to
    /// be added.
    Result<void> add(const Shared<model::SceneSpec>& whole);
    /// Removes a component. The caller has checked that no component refers to it. Its row stays parked until release_parked().
    void remove(std::uint32_t component);
    /// Replaces the component's row by a row of `spec.type`, with values that are already resolved; the old row is parked. On error
    /// nothing has changed.
    Result<void> exchange(std::uint32_t component, const model::ComponentSpec& spec);
    /// Frees the parked rows; changes up to here can no longer be rolled back.
    void release_parked();
    /// Refills roles that refer to all components that fit ("*"), after components were added or removed.
    void refresh_open_roles();
    /// Runs Measure and Prepare of a component again, after its parameters changed.
    Result<void> prepare(std::uint32_t component);
    /// Runs Prepare for everything, in order of dependence: shapes, bodies and shafts, the rest.
    Result<void> prepare_all();

    Backup backup() const;
    void restore(const Backup& backup);

    /// From now on changes of components are noted in `log`, which has to live as long; null: nowhere. Returns the log that was in use.
    UndoLog* note_in(UndoLog* log);
    /// Notes a component as it is, unless it has been, and counts the change (revisions()). To be called before its values or its host row
    /// are changed from outside; prepare(), set() and exchange() do it.
    void note(std::uint32_t component);
    /// Takes back everything in the log, and ends it. Opaque objects that Prepare makes are not covered (as in a backup).
    void take_back(const UndoLog& log);
    /// Values and host rows only: for components whose opaque parts had to be prepared again after take_back().
    void restore_values(const UndoLog& log);

    /// The fields of these kinds (bits) of all existing components, in an order that is constant while the structure is.
    void save_fields(unsigned kinds, ByteWriter& out) const;
    void load_fields(unsigned kinds, ByteReader& in);

    /// Everything as a value (image.h), for this or another world.
    Image image() const;
    /// Fills a world without components from the image, with new directory indices and rows. Prepare makes the opaque parts. After an
    /// error the world is unusable.
    Result<void> revive(const Image& image);
    /// Loads the host rows from the image again, after a stepper has derived values from the structure and written them there.
    void load_host(const Image& image);

    // Looking things up ----------------------------------------------------------------------------------------------
    std::uint32_t find(const std::string& id) const;
    const std::vector<Component>& components() const { return directory_->components; }
    const Component& component(std::uint32_t i) const { return directory_->components[i]; }
    /// A quarantined component takes no part in the step.
    void quarantine(std::uint32_t i, bool quarantined);
    const std::string& id_of(std::uint32_t component) const;
    const std::string& id_of(Ref ref) const { return id_of(host_.component_of(ref)); }
    const model::ComponentType* type_of(std::uint32_t component) const;
    /// Existing components in the order of their ids.
    const std::vector<std::uint32_t>& in_id_order() const { return in_id_order_; }
    const Revisions& revisions() const { return revisions_; }
    /// Position of a component in id order.
    std::uint32_t rank(std::uint32_t component) const { return rank_[component]; }
    std::uint32_t rank(Ref ref) const { return rank_[host_.component_of(ref)]; }
    /// By directory index.
    std::span<const std::uint32_t> ranks() const { return rank_; }
    /// Participants of a role in id order; empty if the type has no such role.
    std::vector<Ref> participants(std::uint32_t component, const Role& role) const;
    /// Calls visit(participant) for each of them.
    template <class Visit>
    void for_each_participant(std::uint32_t component, const Role& role, Visit visit) const
    {
        const Row row = directory_->components[component].row;
        if (role.many)
            for (const Ref ref : (*role.many)[row]) visit(ref);
        else if (const Ref ref = (*role.one)[row]; ref.valid())
            visit(ref);
    }
    /// Directory indices of the components that refer to `component` through a role.
    std::vector<std::uint32_t> referrers(std::uint32_t component) const;

    // Fields ---------------------------------------------------------------------------------------------------------
    /// The live value of a field, also of a hosted one; "state.count" reads an entry. Empty if it does not exist.
    Value get(std::uint32_t component, const std::string& field) const;
    /// Sets a param or state field without running Prepare. The value must have the field's type.
    Result<void> set(std::uint32_t component, const std::string& field, const Value& value);

    /// The largest value among the outputs that the component's type declares as its error; 0 if it declares none.
    double largest_error(std::uint32_t component) const;

    std::vector<std::unique_ptr<Table>>& tables() { return tables_; }
    const std::vector<std::unique_ptr<Table>>& tables() const { return tables_; }
    Table& table_of(std::uint32_t i) { return *tables_[component(i).table]; }
    const Table& table_of(std::uint32_t i) const { return *tables_[component(i).table]; }
    HostTables& host() { return host_; }
    const HostTables& host() const { return host_; }
    const model::SceneSpec& scene() const { return *scene_; }
    /// The present scene, for any thread. Its holder recognises by its address whether the scene has changed since.
    std::shared_ptr<const model::SceneSpec> lend_scene() const { return scene_.lend(); }
    /// Sets the settings and the file name; to be called before components are added.
    void describe(const model::SceneSettings& settings, const std::string& file);
    model::TypeSource& types() const { return *types_; }

    /// Hash over the raw bits of all state, in id order (server/docs/determinism.md).
    std::uint64_t state_hash(std::uint64_t start) const;
    /// Raw state of one component: its state columns and its host row.
    void save_state(std::uint32_t component, ByteWriter& out) const;

private:
    struct Created
    {
        std::uint32_t component;
        const model::ComponentSpec* spec;
    };
    std::vector<Created> create_from(std::size_t first, Errors& errors);
    std::vector<Created> in_order_of_preparation(const std::vector<Created>& created) const;
    Result<void> add_from(std::size_t first);
    void load_cells(const Image& image, Errors& errors);
    Result<std::uint32_t> create(const model::ComponentSpec& spec);
    Result<std::uint32_t> table_for(const std::string& type);
    void fill_fields(Table& table, Row row, const model::ComponentSpec& spec);
    void bind(std::uint32_t component, const model::ComponentSpec& spec);
    void bind_role(const Role& role, Row row, const model::RoleSpec* spec);
    /// Those that fit and match one of the patterns, or all that fit if there are none.
    std::vector<Ref> everyone_in(const Role& role, const std::vector<std::string>& patterns) const;
    void initialize_motion(std::uint32_t component);
    void restore_structure(const Backup& backup);
    std::uint32_t insert(Component component);
    void erase(std::uint32_t component);
    void sort_by_id();
    void count_change(const model::ComponentType& type);
    Result<void> run(std::uint32_t component, Phase phase);
    Result<void> measure(std::uint32_t component);
    std::uint64_t enabled_commands(const model::ComponentType& type, const model::ComponentSpec& spec) const;
    int prepare_order(std::uint32_t component) const;

    model::TypeSource* types_;
    std::vector<std::unique_ptr<Table>> tables_;
    std::map<std::string, std::uint32_t> table_of_type_;
    Shared<Directory> directory_;
    Shared<model::SceneSpec> scene_;
    std::vector<std::uint32_t> in_id_order_, rank_;
    HostTables host_;
    std::vector<Parked> parked_;
    UndoLog* undo_ = nullptr;
    Revisions revisions_;
};

}  // namespace plab::world
