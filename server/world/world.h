/// A scene's components as they stand at one time: tables, host tables, the directory of who is who.
///
/// The world knows no time and no phases; server/simulation steps it. Rows are born and die only through create,
/// exchange and remove, which simulation calls at step boundaries.
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
#include "world/shared.h"
#include "world/table.h"

namespace plab::world
{

/// A directory entry. The index stays with the id for as long as a component of that id lives, also across swaps.
struct Component
{
    std::string id;
    std::uint32_t table = kNoIndex;  ///< kNoIndex: a group
    Row row = kNoIndex;
    Facet facet = Facet::Component;
    std::uint32_t host_index = kNoIndex;
    std::uint64_t commands = 0;  ///< bit per command of its type: takes part
    bool alive = false;
    bool quarantined = false;

    /// How roles refer to it.
    Ref ref(std::uint32_t directory_index) const
    {
        return facet == Facet::Component ? Ref{facet, directory_index} : Ref{facet, host_index};
    }
};

/// Who is who. Changed only by requests.
struct Directory
{
    std::vector<Component> components;
    std::map<std::string, std::uint32_t> index_of_id;
    std::vector<std::uint32_t> free;
};

/// A row that belongs to nobody, and is kept because a rollback may want it back.
struct Parked
{
    std::uint32_t table;
    Row row;
    std::uint32_t host_index;  ///< to be freed with the row, or kNoIndex
    Facet facet;
    friend bool operator==(const Parked&, const Parked&) = default;
};

/// What a swap or rollback needs to bring everything back, except opaque objects, whose rows stay parked.
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
    /// Adds all components of `scene` or none; ids must be new. Binds roles and prepares rows.
    Result<void> add(const model::SceneSpec& scene);
    /// Takes a component away. The caller has checked that nobody refers to it. Its row is parked until release().
    void remove(std::uint32_t component);
    /// Puts a row of `spec.type` in the place of the component's row, with values already resolved; the old row is
    /// parked. On error nothing has changed.
    Result<void> exchange(std::uint32_t component, const model::ComponentSpec& spec);
    /// Frees parked rows: nothing can be rolled back past this.
    void release_parked();
    /// Fills again roles that mean everybody ("*"), after components came or went.
    void refresh_open_roles();
    /// Re-runs Measure and Prepare of a component after its parameters changed.
    Result<void> prepare(std::uint32_t component);
    /// Prepare of everything, in order of dependence: shapes, bodies and shafts, the rest.
    Result<void> prepare_all();

    Backup backup() const;
    void restore(const Backup& backup);

    /// The fields of these kinds (bits) of all living components, in an order that stands as long as the structure does.
    void save_fields(unsigned kinds, ByteWriter& out) const;
    void load_fields(unsigned kinds, ByteReader& in);

    /// Everything as a value (image.h), for this or another world.
    Image image() const;
    /// Makes a world without components into that of the image, under new directory indices and rows. Opaque parts are made
    /// by Prepare. On error the world is of no use any more.
    Result<void> revive(const Image& image);
    /// Host rows as they are in the image, again: what a stepper derives from structure may touch them.
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
    /// Living components in the order of their ids.
    const std::vector<std::uint32_t>& in_id_order() const { return in_id_order_; }
    /// Position of a component in id order.
    std::uint32_t rank(std::uint32_t component) const { return rank_[component]; }
    std::uint32_t rank(Ref ref) const { return rank_[host_.component_of(ref)]; }
    /// Participants of a role in id order; empty if the type has no such role.
    std::vector<Ref> participants(std::uint32_t component, const Role& role) const;
    /// Directory indices of those that refer to `component` through a role.
    std::vector<std::uint32_t> referrers(std::uint32_t component) const;

    // Fields ---------------------------------------------------------------------------------------------------------
    /// The live value of a field, hosted ones included; "state.count" reads an entry. No value if there is none.
    Value get(std::uint32_t component, const std::string& field) const;
    /// Sets a param or state field without running Prepare. The value must have the field's type.
    Result<void> set(std::uint32_t component, const std::string& field, const Value& value);

    /// The largest output of a component that is declared as its error; 0 if it has none.
    double largest_error(std::uint32_t component) const;

    std::vector<std::unique_ptr<Table>>& tables() { return tables_; }
    const std::vector<std::unique_ptr<Table>>& tables() const { return tables_; }
    Table& table_of(std::uint32_t i) { return *tables_[component(i).table]; }
    const Table& table_of(std::uint32_t i) const { return *tables_[component(i).table]; }
    HostTables& host() { return host_; }
    const HostTables& host() const { return host_; }
    const model::SceneSpec& scene() const { return *scene_; }
    /// Settings and file; before components are added.
    void describe(const model::SceneSettings& settings, const std::string& file);
    model::TypeSource& types() const { return *types_; }

    /// Over the raw bits of all state, in id order (server/docs/determinism.md).
    std::uint64_t state_hash(std::uint64_t start) const;
    /// Raw state of one component: its state columns and its host row.
    void save_state(std::uint32_t component, ByteWriter& out) const;

private:
    struct Created
    {
        std::uint32_t component;
        const model::ComponentSpec* spec;
    };
    std::vector<Created> create_all(const model::SceneSpec& scene, Errors& errors);
    void load_cells(const Image& image, Errors& errors);
    Result<std::uint32_t> create(const model::ComponentSpec& spec);
    Result<std::uint32_t> table_for(const std::string& type);
    void fill_fields(Table& table, Row row, const model::ComponentSpec& spec);
    void bind(std::uint32_t component, const model::ComponentSpec& spec);
    void bind_role(const Role& role, Row row, const model::RoleSpec* spec);
    std::vector<Ref> everyone_in(const Role& role) const;
    void initialize_motion(std::uint32_t component);
    void restore_structure(const Backup& backup);
    std::uint32_t insert(Component component);
    void erase(std::uint32_t component);
    void sort_by_id();
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
};

}  // namespace plab::world
