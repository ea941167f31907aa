/// What a server says of its scene, as plain values: a snapshot that can be kept up to date.
///
///   auto catalogue = link::Catalogue::open(session);
///   if (catalogue->fetch(2s)) for (const auto& [id, object] : catalogue->now().objects) ...
///   while (running) { if (catalogue->update()) redraw(catalogue->now()); ... }
///
/// Units and meanings of the fields stand in idl/plab.idl.
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "link/session.h"

namespace plab::link
{

/// The topics that a catalogue reads. Omitted topics cost nothing.
enum class Part : unsigned
{
    Server = 1,
    Scene = 2,
    Objects = 4,
    Shapes = 8,
    Interactions = 16,
    Types = 32,
    Metrics = 64,
};
using Parts = unsigned;
constexpr Parts operator|(Part a, Part b) { return static_cast<Parts>(a) | static_cast<Parts>(b); }
constexpr Parts operator|(Parts a, Part b) { return a | static_cast<Parts>(b); }
constexpr bool has(Parts parts, Part part) { return (parts & static_cast<Parts>(part)) != 0; }
inline constexpr Parts kEverything = 127;

struct CatalogueContents
{
    std::optional<ServerInfo> server;  ///< empty: it has gone
    std::optional<Scene> scene;
    std::map<std::string, Object> objects;
    std::map<std::string, Shape> shapes;
    std::map<std::string, Interaction> interactions;
    std::map<std::string, Type> types;
    std::optional<Metrics> metrics;
};

/// Not thread-safe; must not outlive the session.
class Catalogue
{
public:
    /// Subscribes; the contents arrive with fetch() or update(). The scene is always read, because it contains the counts of
    /// the rest.
    static Result<Catalogue> open(const Session& session, Parts parts = kEverything);

    /// Waits until everything that the server keeps for late joiners has arrived. An error names what is missing at the
    /// time-out.
    Result<void> fetch(Seconds timeout, const Stop& stop = {});
    /// Takes what has arrived, without waiting; true if something changed.
    bool update();
    /// Waits for a change until `timeout`, and takes it.
    bool wait(Seconds timeout);

    const CatalogueContents& now() const { return now_; }
    /// Counts changes of the contents (except the server's state and metrics): for caches of code that draws or prints.
    std::uint64_t version() const { return version_; }
    /// The server was there and has gone since: ended, or silent for longer than its lease.
    bool server_is_gone() const { return was_there_ && !now_.server; }
    /// The object with this `handle` in frames; null if there is none.
    const Object* find_object(std::uint32_t handle) const;

private:
    std::string missing() const;
    bool take_state();
    bool take_things();
    void rebuild_handles();

    const Session* session_ = nullptr;
    Parts parts_ = 0;
    wire::DataReader<plab_v2_Server> server_;
    wire::DataReader<plab_v2_Scene> scene_;
    wire::DataReader<plab_v2_SceneObject> objects_;
    wire::DataReader<plab_v2_Shape> shapes_;
    wire::DataReader<plab_v2_Interaction> interactions_;
    wire::DataReader<plab_v2_Type> types_;
    wire::DataReader<plab_v2_Metrics> metrics_;
    wire::Entity waitset_;
    CatalogueContents now_;
    std::map<std::uint32_t, std::string> handles_;
    std::uint64_t version_ = 0;
    bool was_there_ = false;
};

}  // namespace plab::link
