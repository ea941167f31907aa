// Snapshots as bytes: written snapshots are read back, and any other bytes are refused with a reason.
#include "simulation/snapshot/format.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "mixed_scene.h"
#include "simulation/snapshot/sections.h"
#include "twin.h"
#include "world/state_hash.h"

using namespace plab;
using namespace plab::test;
using namespace plab::simulation;

namespace
{

using Bytes = std::vector<std::uint8_t>;

std::unique_ptr<Simulation> mixed(int steps = 60)
{
    auto s = started(scene_of(kMixed));
    for (int i = 0; i < steps; ++i) s->step();
    return s;
}

Bytes encoded(const Snapshot& snapshot)
{
    auto bytes = encode(snapshot);
    REQUIRE_MESSAGE(bytes.ok(), reasons(bytes));
    return bytes.take();
}

/// The file's sections with a correct checksum, whatever was done to them.
Bytes rewritten(const Bytes& bytes, const std::function<void(std::vector<Section>&)>& change, std::uint32_t version = kSnapshotFormat)
{
    auto file = read_sections(bytes, kSnapshotFormat);
    REQUIRE(file.ok());
    change(file->sections);
    return write_sections(version, file->sections);
}

Section& section(std::vector<Section>& sections, const std::string& name)
{
    const auto at = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
    REQUIRE(at != sections.end());
    return *at;
}

ColumnData& column(std::vector<Section>& sections, const std::string& in, const std::string& name)
{
    Section& s = section(sections, in);
    const auto at = std::find_if(s.columns.begin(), s.columns.end(), [&](const NamedColumn& c) { return c.name == name; });
    REQUIRE(at != s.columns.end());
    return at->data;
}

/// Why the bytes are refused; empty if they are taken.
std::string refusal(const Bytes& bytes)
{
    const auto file = decode(bytes, library());
    return file.ok() ? std::string() : file.error().text();
}

bool mentions(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("a snapshot that was written to bytes and read back is the same, and so is its future")
{
    const auto s = mixed();
    const Snapshot snapshot = s->capture();
    REQUIRE(snapshot->contacts.pairs.heads.size() == 1);
    REQUIRE(snapshot->contacts.force_pairs.heads.size() == 1);
    const std::vector<SnapshotNote> notes{{"name", "before\nthe \"swap\""}, {"", ""}};
    const auto bytes = encode(snapshot, {}, notes);
    REQUIRE(bytes.ok());
    const auto file = decode(*bytes, library());
    REQUIRE_MESSAGE(file.ok(), reasons(file));
    CHECK(file->notes == notes);
    CHECK(mentions(file->build, "compiler"));
    CHECK(difference_of(snapshot, file->snapshot).empty());
    CHECK(file->snapshot->state_hash == snapshot->state_hash);
    CHECK(encoded(file->snapshot).size() == encoded(snapshot).size());

    Simulation twin(library());
    const auto restored = twin.restore(file->snapshot);
    REQUIRE_MESSAGE(restored.ok(), reasons(restored));
    for (int i = 0; i < 200; ++i)
    {
        s->step(), twin.step();
        REQUIRE(footprint(*s) == footprint(twin));
    }
    CHECK(difference_of(s->capture(), twin.capture()).empty());
}

TEST_CASE("scenes are restored as they were described: a swap after restoring has the same effect")
{
    for (const Subject& subject : subjects())
    {
        const auto scene = compiled(subject.blueprint);
        const auto s = started(scene);
        const auto file = decode(encoded(s->capture()), library());
        REQUIRE_MESSAGE(file.ok(), subject.type, ": ", reasons(file));
        const model::SceneSpec& again = *file->snapshot->world.scene;
        REQUIRE(again.components.size() == scene.components.size());
        for (std::size_t i = 0; i < scene.components.size(); ++i)
        {
            const model::ComponentSpec &a = scene.components[i], &b = again.components[i];
            CHECK(std::tie(a.id, a.name, a.type, a.parent, a.alias_of, a.group, a.explicit_commands, a.commands, a.generated) ==
                  std::tie(b.id, b.name, b.type, b.parent, b.alias_of, b.group, b.explicit_commands, b.commands, b.generated));
            REQUIRE(a.fields.size() == b.fields.size());
            for (std::size_t k = 0; k < a.fields.size(); ++k) CHECK(a.fields[k].name == b.fields[k].name);
            REQUIRE(a.roles.size() == b.roles.size());
            for (std::size_t k = 0; k < a.roles.size(); ++k)
                CHECK(std::tie(a.roles[k].name, a.roles[k].members, a.roles[k].everyone, a.roles[k].patterns) ==
                      std::tie(b.roles[k].name, b.roles[k].members, b.roles[k].everyone, b.roles[k].patterns));
        }
    }
}

TEST_CASE("unusual values keep their bits")
{
    const auto s = started(scene_of(kMixed));
    const double nan = std::bit_cast<double>(0x7ff8dead0000beefull);
    auto odd = std::make_shared<SnapshotContent>(*s->capture());
    odd->world.bodies.velocity[0] = {-0.0, std::numeric_limits<double>::infinity(), nan};
    odd->world.bodies.mass[0] = 4.9e-324;
    odd->clock.base_time = -0.0;
    const auto file = decode(encoded(Snapshot(odd)), library());
    REQUIRE(file.ok());
    const Vec3 v = file->snapshot->world.bodies.velocity[0];
    CHECK(std::bit_cast<std::uint64_t>(v.z) == 0x7ff8dead0000beefull);
    CHECK(difference_of(Snapshot(odd), file->snapshot).empty());
}

TEST_CASE("waiting requests need a textual form for the file")
{
    const auto s = mixed(5);
    Request request;
    request.at = 50, request.operations = {PauseOperation{}};
    s->post(request);
    CHECK(!encode(s->capture()).ok());
    const std::vector<std::string> words{"pause at 50"};
    const auto bytes = encode(s->capture(), words);
    REQUIRE(bytes.ok());
    const auto file = decode(*bytes, library());
    REQUIRE(file.ok());
    CHECK(file->waiting == words);
    CHECK(file->snapshot->waiting.empty());
}

TEST_CASE("every cut is refused")
{
    const Bytes whole = encoded(mixed(60)->capture());
    for (std::size_t n = 0; n < whole.size(); ++n)
    {
        const auto file = read_sections(std::span(whole).first(n), kSnapshotFormat);
        REQUIRE(!file.ok());
    }
    CHECK(mentions(refusal({}), "truncated"));
    CHECK(mentions(refusal(Bytes(whole.begin(), whole.end() - 1)), "should have"));
}

TEST_CASE("every flipped bit is refused")
{
    Bytes bytes = encoded(mixed(60)->capture());
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        const auto bit = static_cast<std::uint8_t>(1u << (i % 8));
        bytes[i] ^= bit;
        const auto file = read_sections(bytes, kSnapshotFormat);
        REQUIRE(!file.ok());
        bytes[i] ^= bit;
    }
    CHECK(refusal(bytes).empty());
}

TEST_CASE("damage under a correct checksum gives a reason or a whole snapshot, and never takes more memory than the file's size justifies")
{
    const Bytes whole = encoded(mixed(60)->capture());
    std::size_t refused = 0, n = 0;
    for (std::size_t i = 20; i + 8 < whole.size(); i += 17, ++n)
    {
        Bytes bytes = whole;
        bytes[i] = static_cast<std::uint8_t>(bytes[i] + 0x7f);
        const std::uint64_t sum = world::hash_bytes(0xcbf29ce484222325ull, std::span(bytes).first(bytes.size() - 8));
        std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
        const auto file = decode(bytes, library());
        refused += file.ok() ? 0 : 1;
        if (!file) continue;
        Simulation twin(library());
        (void)twin.restore(file->snapshot);
    }
    CHECK(refused > n / 2);
}

TEST_CASE("versions, unknown names and missing parts are reported by name")
{
    const Bytes whole = encoded(mixed(60)->capture());
    CHECK(mentions(refusal(rewritten(
                       whole, [](auto&) {}, 2)),
                   "has format 2, this build reads 1 to 1"));
    CHECK(mentions(refusal(Bytes{'G', 'I', 'F', '8'}), "not a pLab snapshot"));
    const auto with = [&](const std::function<void(std::vector<Section>&)>& change) { return refusal(rewritten(whole, change)); };
    CHECK(with([](auto&) {}).empty());
    CHECK(mentions(with([](auto& s) { s.push_back({"tides", 0, {}}); }), "'tides' is unknown"));
    CHECK(mentions(with([](auto& s) { s.push_back(section(s, "bodies")); }), "'bodies' occurs twice"));
    CHECK(mentions(with(
                       [](auto& s) {
                           section(s, "bodies").columns.push_back({"charge", std::vector<double>(3)});
                       }),
                   "'charge' is unknown"));
    CHECK(mentions(with([](auto& s) { column(s, "bodies", "mass") = std::vector<std::string>(3); }), "'mass' has another type"));
    CHECK(mentions(with([](auto& s) { section(s, "cells.Shape/Sphere").columns[1].name = "girth"; }), "'girth' is unknown"));
    CHECK(mentions(with([](auto& s) { std::erase_if(s, [](const Section& x) { return x.name == "run"; }); }), "'run' of one row"));
    CHECK(mentions(with([](auto& s) { std::erase_if(s, [](const Section& x) { return x.name == "bodies"; }); }),
                   "is not in the snapshot's section 'bodies'"));
    CHECK(mentions(with([](auto& s) { std::get<std::vector<std::string>>(column(s, "components", "type"))[1] = "Shape/Klein"; }),
                   "Shape/Klein"));
    // Fields added after the file was written have their default.
    CHECK(with([](auto& s) { std::erase_if(section(s, "bodies").columns, [](const NamedColumn& c) { return c.name == "sunk_last"; }); })
              .empty());
}

TEST_CASE("a state that was added to its type after the file was written has its default")
{
    const Bytes older = rewritten(encoded(mixed(60)->capture()),
                                  [](auto& s)
                                  {
                                      auto& columns = section(s, "cells.Script/Lua").columns;
                                      std::erase_if(columns, [](const NamedColumn& c) { return c.name == "random_state"; });
                                  });
    const auto file = decode(older, library());
    REQUIRE_MESSAGE(file.ok(), reasons(file));
    Simulation s(library());
    const auto restored = s.restore(file->snapshot);
    REQUIRE_MESSAGE(restored.ok(), reasons(restored));
    CHECK(std::get<std::int64_t>(s.world().get(s.world().find("watch"), "random_state")) == 0);
    CHECK(s.step());
}

TEST_CASE("plugins that the scene needs are loaded")
{
    const Bytes bytes = encoded(mixed(60)->capture());
    plugins::PluginLibrary fresh({PLAB_BINARY_DIR "/lib/plab"});
    REQUIRE(fresh.loaded().empty());
    const auto file = decode(bytes, fresh);
    REQUIRE_MESSAGE(file.ok(), reasons(file));
    plugins::PluginLibrary other({PLAB_BINARY_DIR "/lib/plab"});
    Simulation s(other);
    const auto restored = s.restore(file->snapshot);
    REQUIRE_MESSAGE(restored.ok(), reasons(restored));
    CHECK(!other.loaded().empty());
    CHECK(s.state_hash() == file->snapshot->state_hash);
}

TEST_CASE("inconsistent snapshots are refused")
{
    const Bytes whole = encoded(mixed(60)->capture());
    const auto with = [&](const std::function<void(std::vector<Section>&)>& change) { return !refusal(rewritten(whole, change)).empty(); };
    const auto index = [](ColumnData& c) -> std::vector<std::uint32_t>& { return std::get<std::vector<std::uint32_t>>(c); };
    CHECK(with([&](auto& s) { index(column(s, "bodies", "component"))[0] = 4000; }));
    CHECK(with([&](auto& s) { index(column(s, "bodies", "component"))[0] = index(column(s, "bodies", "component"))[1]; }));
    CHECK(with([&](auto& s) { index(column(s, "shafts", "root"))[1] = 0; }));
    CHECK(with([&](auto& s) { index(column(s, "pairs", "points"))[0] = 1000; }));
    CHECK(with([&](auto& s) { index(column(s, "pairs", "a"))[0] = 77; }));
    CHECK(with([&](auto& s) { index(column(s, "role_members", "of"))[0] = 9999; }));
    CHECK(with([&](auto& s) { index(column(s, "fields", "component"))[0] = 9999; }));
    CHECK(with([&](auto& s) { std::get<std::vector<std::string>>(column(s, "components", "id"))[0] = "ball"; }));
    CHECK(with([&](auto& s) { std::get<std::vector<std::string>>(column(s, "components", "parent"))[0] = "ground"; }) == true);
    CHECK(with([&](auto& s) { std::get<std::vector<std::string>>(column(s, "role_members", "text"))[0] = "nobody"; }));
    CHECK(with([&](auto& s) { std::get<std::vector<double>>(column(s, "clock", "dt"))[0] = 0; }));
    CHECK(with([&](auto& s) { std::get<std::vector<std::string>>(column(s, "bodies", "motion"))[0] = "liquid"; }));
}

TEST_CASE("a file of format 1 continues as it did when it was written")
{
    std::ifstream in(std::string(PLAB_SOURCE_DIR) + "/tests/unit/snapshot/golden/format_1.snapshot", std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(in), {}};
    const auto file = decode(bytes, library());
    REQUIRE_MESSAGE(file.ok(), reasons(file));
    Simulation s(library());
    const auto restored = s.restore(file->snapshot);
    REQUIRE_MESSAGE(restored.ok(), reasons(restored));
    CHECK(s.tick() == 60);
    CHECK(s.state_hash() == file->snapshot->state_hash);
    // From the build that wrote the file; gcc 12.2.
    REQUIRE(file->notes.size() == 1);
    REQUIRE(file->notes[0].name == "hash at step 160");
    for (int i = 0; i < 100; ++i) s.step();
    CHECK(std::to_string(s.state_hash()) == file->notes[0].text);
}
