// What the scene consists of, for early and for late readers; and the server itself.
#include <map>
#include <set>

#include "support.h"

using namespace plab;
using namespace plab::test;

namespace
{

using Ids = std::set<std::string>;

wire::SceneObject object(const std::string& id)
{
    wire::SceneObject entry;
    entry.component_id = id, entry.type_name = "Component", entry.shape_of = "body", entry.motion = "dynamic", entry.mass = 2;
    entry.shapes = {id + ".shape"};
    entry.parameters = {{"mass", "2", "kg", "param"}};
    return entry;
}

wire::Shape tetrahedron(const std::string& id)
{
    wire::Shape entry;
    entry.component_id = id, entry.type_name = "Shape/Mesh", entry.form = "mesh";
    entry.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    entry.triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return entry;
}

wire::Interaction interaction(const std::string& id, const std::string& type)
{
    wire::Interaction entry;
    entry.component_id = id, entry.type_name = type, entry.roles = {{"driver", {"a"}}, {"driven", {"b", "c"}}};
    return entry;
}

publish::CatalogueChange everything()
{
    publish::CatalogueChange change;
    change.everything = true;
    change.scene.run = 1, change.scene.title = "title", change.scene.cameras.push_back({"front", {}, {}, {}, 0.5});
    change.objects = {object("a"), object("b")};
    change.shapes = {tetrahedron("a.shape")};
    change.interactions = {interaction("gear", "G/A")};
    wire::Type type;
    type.type_name = "G/A", type.roles = {{"driver", "body", 1, 1, ""}}, type.fields.resize(2);
    change.types = {type};
    return change;
}

/// The instances that a reader knows to be alive, and how many disposals it saw.
template <class T, char* T::*Key>
class Alive
{
public:
    explicit Alive(const link::Session& session) : reader_(reader_of<T>(session)) {}
    const Ids& ids()
    {
        (void)reader_.take(
            [&](const T& sample, const dds_sample_info_t& info)
            {
                if (info.instance_state == DDS_IST_ALIVE)
                    ids_.insert(sample.*Key);
                else
                    ++dead_;
                if (info.instance_state == DDS_IST_NOT_ALIVE_DISPOSED) disposed_ += ids_.erase(sample.*Key);
            });
        return ids_;
    }
    bool becomes(const Ids& expected)
    {
        return eventually([&] { return ids() == expected; });
    }
    std::size_t disposed() const { return disposed_; }
    /// Samples of instances that are not alive.
    std::size_t dead() const { return dead_; }

private:
    wire::DataReader<T> reader_;
    Ids ids_;
    std::size_t disposed_ = 0, dead_ = 0;
};
using LiveObjects = Alive<plab_v2_SceneObject, &plab_v2_SceneObject::component_id>;
using LiveShapes = Alive<plab_v2_Shape, &plab_v2_Shape::component_id>;
using LiveInteractions = Alive<plab_v2_Interaction, &plab_v2_Interaction::component_id>;
using LiveTypes = Alive<plab_v2_Type, &plab_v2_Type::type_name>;
using LiveScenes = Alive<plab_v2_Scene, &plab_v2_Scene::server_name>;
using LiveServers = Alive<plab_v2_Server, &plab_v2_Server::name>;

}  // namespace

TEST_CASE("a late reader finds the whole catalogue, and nothing that was removed before")
{
    TestBus bus;
    REQUIRE(bus->catalogue(everything()));
    publish::CatalogueChange change;
    change.objects = {object("c")};
    change.gone = {"b"};
    REQUIRE(bus->catalogue(std::move(change)));
    std::this_thread::sleep_for(50ms);
    const link::Session late = bus.session();
    LiveObjects objects(late);
    CHECK(objects.becomes({"a", "c"}));
    CHECK(LiveShapes(late).becomes({"a.shape"}));
    CHECK(LiveInteractions(late).becomes({"gear"}));
    CHECK(LiveTypes(late).becomes({"G/A"}));
    CHECK(LiveScenes(late).becomes({bus.options().name}));
    CHECK(objects.dead() == 0);
}

TEST_CASE("catalogue samples carry what was recorded")
{
    TestBus bus;
    const link::Session session = bus.session();
    auto shapes = reader_of<plab_v2_Shape>(session);
    auto interactions = reader_of<plab_v2_Interaction>(session);
    auto scenes = reader_of<plab_v2_Scene>(session);
    REQUIRE(bus->catalogue(everything()));
    REQUIRE(session.wait(scenes, 5s));  // written last
    REQUIRE(session.wait(shapes, 5s));
    (void)shapes.take(
        [&](const plab_v2_Shape& s, const dds_sample_info_t&)
        {
            CHECK(std::string(s.form) == "mesh");
            REQUIRE(s.vertices._length == 4);
            CHECK(s.vertices._buffer[3].z == 1);
            REQUIRE(s.triangles._length == 12);
            CHECK(s.triangles._buffer[11] == 3);
        });
    REQUIRE(session.wait(interactions, 5s));
    (void)interactions.take(
        [&](const plab_v2_Interaction& i, const dds_sample_info_t&)
        {
            REQUIRE(i.roles._length == 2);
            REQUIRE(i.roles._buffer[1].members._length == 2);
            CHECK(std::string(i.roles._buffer[1].members._buffer[1]) == "c");
            CHECK(std::string(i.roles._buffer[0].role) == "driver");
        });
    (void)scenes.take(
        [&](const plab_v2_Scene& s, const dds_sample_info_t&)
        {
            REQUIRE(s.cameras._length == 1);
            CHECK(std::string(s.cameras._buffer[0].name) == "front");
        });
}

TEST_CASE("removed instances are disposed of; a new scene disposes of those that it does not name; types stay unless they are given")
{
    TestBus bus;
    const link::Session session = bus.session();
    LiveObjects objects(session);
    LiveInteractions interactions(session);
    LiveTypes types(session);
    REQUIRE(bus->catalogue(everything()));
    REQUIRE(objects.becomes({"a", "b"}));
    REQUIRE(interactions.becomes({"gear"}));
    REQUIRE(types.becomes({"G/A"}));

    publish::CatalogueChange removal;
    removal.gone = {"b", "never.there"};
    REQUIRE(bus->catalogue(std::move(removal)));
    CHECK(objects.becomes({"a"}));
    CHECK(objects.disposed() == 1);

    publish::CatalogueChange next;
    next.everything = true, next.objects = {object("z")};
    REQUIRE(bus->catalogue(std::move(next)));
    CHECK(objects.becomes({"z"}));
    CHECK(interactions.becomes({}));
    CHECK(types.becomes({"G/A"}));

    publish::CatalogueChange back;  // an instance that was removed may come again, also as another kind
    back.objects = {object("b")}, back.interactions = {interaction("z", "G/A")};
    REQUIRE(bus->catalogue(std::move(back)));
    CHECK(interactions.becomes({"z"}));
    CHECK(objects.becomes({"b"}));
}

TEST_CASE("a catalogue change that finds no room is refused, and the whole catalogue then restores a consistent state")
{
    TestBus bus;
    const link::Session session = bus.session();
    LiveObjects objects(session);
    bool refused = false;
    for (int i = 0; i < 200000 && !refused; ++i)
    {
        publish::CatalogueChange change;
        for (int k = 0; k < 20; ++k) change.objects.push_back(object("o" + std::to_string(k)));
        refused = !bus->catalogue(std::move(change));
    }
    REQUIRE(refused);
    CHECK(eventually([&] { return bus->catalogue(everything()); }));
    CHECK(objects.becomes({"a", "b"}));
}

TEST_CASE("the server announces itself at least once a second")
{
    TestBus bus;
    const link::Session session = bus.session();
    auto reader = reader_of<plab_v2_Server>(session);
    wire::Server status;
    status.scene_file = "s.xml", status.step = 12, status.overload = "slip";
    bus->status(status);
    int samples = 0;
    const auto count = [&](const plab_v2_Server& s, const dds_sample_info_t& info)
    {
        if (!info.valid_data) return;
        ++samples;
        CHECK(s.process == getpid());
        CHECK(s.step == 12);
        CHECK(std::string(s.overload) == "slip");
        CHECK(std::string(s.version) == "test");
        CHECK(s.started_ns > 0);
        CHECK(s.dropped._length == 0);
    };
    std::vector<std::chrono::steady_clock::time_point> came;
    while (came.size() < 3 && session.wait(reader, 3s))
        if (reader.take(count) > 0) came.push_back(std::chrono::steady_clock::now());
    REQUIRE(samples == 3);
    CHECK(came[2] - came[1] > 500ms);
    CHECK(came[2] - came[1] < 1500ms);
}

TEST_CASE("a server that ends disposes of all it has shown, and does not take long")
{
    TestBus bus;
    const link::Session session = bus.session();
    LiveObjects objects(session);
    LiveTypes types(session);
    LiveScenes scenes(session);
    LiveServers servers(session);
    REQUIRE(bus->catalogue(everything()));
    bus->status({});
    REQUIRE(objects.becomes({"a", "b"}));
    REQUIRE(types.becomes({"G/A"}));
    REQUIRE(servers.becomes({bus.options().name}));
    REQUIRE(scenes.becomes({bus.options().name}));
    const auto begin = std::chrono::steady_clock::now();
    bus.close();
    const auto took = std::chrono::steady_clock::now() - begin;
    MESSAGE("the end took " << std::chrono::duration<double, std::milli>(took).count() << " ms");
    CHECK(took < 1500ms);
    CHECK(objects.becomes({}));
    CHECK(objects.disposed() == 2);
    CHECK(types.becomes({}));
    CHECK(scenes.becomes({}));
    CHECK(servers.becomes({}));
}
