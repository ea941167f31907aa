// driver, driven and between[i]: what a script reads from the host tables, and the forces that it adds.
#include <cmath>
#include <cstdio>
#include <new>
#include <vector>

#include "lua/freeze.h"
#include "lua/native.h"

namespace plab::scripts
{
namespace
{

/// One object for the lifetime of the machine; only `ref` follows the role.
struct ParticipantObject : Object
{
    int place = 0;  // 0: driver, -1: driven, i: between[i]
    Ref ref;
};

constexpr int kDriverPlace = 0, kDrivenPlace = -1;

struct RoleName
{
    explicit RoleName(int place)
    {
        if (place > 0)
            std::snprintf(text, sizeof text, "between[%d]", place);
        else
            std::snprintf(text, sizeof text, "%s", place == kDriverPlace ? "driver" : "driven");
    }
    char text[24];
};

std::size_t rows_of(const Call& call, Facet facet)
{
    if (facet == Facet::Quantities) return call.quantities->size();
    return facet == Facet::Body ? call.bodies->size() : call.shafts->size();
}

/// The row from which the participant is read. Host tables only grow while a script lives, so an invalid index is an error of
/// the host, or the participant has been removed.
const Call& readable(lua_State* lua, const ParticipantObject& p)
{
    const Call& call = running_call(lua, "participants");
    if (p.ref.index >= rows_of(call, p.ref.facet)) luaL_error(lua, "%s has no participant", RoleName(p.place).text);
    return call;
}

/// The values that can be read from one kind of participant, in its host table.
template <class Host>
struct Reading
{
    NativeValue value;
    void (*push)(lua_State* lua, const Host& host, std::uint32_t i);
};

constexpr Reading<Shafts> kShaftReadings[] = {
    {{"angle", "rad", "not wrapped"}, [](lua_State* lua, const Shafts& s, std::uint32_t i) { lua_pushnumber(lua, s.angle[i]); }},
    {{"speed", "rad/s", ""}, [](lua_State* lua, const Shafts& s, std::uint32_t i) { lua_pushnumber(lua, s.speed[i]); }},
    {{"inertia", "kg m2", ""}, [](lua_State* lua, const Shafts& s, std::uint32_t i) { lua_pushnumber(lua, s.inertia[i]); }}};
constexpr Reading<Quantities> kQuantitiesReadings[] = {{{"count", "", "how many values"},
                                                        [](lua_State* lua, const Quantities& q, std::uint32_t i)
                                                        { lua_pushinteger(lua, static_cast<lua_Integer>(q.value[i].size())); }}};
constexpr Reading<Bodies> kBodyReadings[] = {
    {{"position", "m", "of the centre of mass, in the world"},
     [](lua_State* lua, const Bodies& b, std::uint32_t i) { push_vector(lua, b.position[i]); }},
    {{"velocity", "m/s", "of the centre of mass, in the world"},
     [](lua_State* lua, const Bodies& b, std::uint32_t i) { push_vector(lua, b.velocity[i]); }},
    {{"angular_velocity", "rad/s", "in the world"},
     [](lua_State* lua, const Bodies& b, std::uint32_t i) { push_vector(lua, b.angular_velocity[i]); }},
    {{"orientation", "", "from the body's axes to the world's"},
     [](lua_State* lua, const Bodies& b, std::uint32_t i) { push_rotation(lua, b.orientation[i]); }},
    {{"mass", "kg", ""}, [](lua_State* lua, const Bodies& b, std::uint32_t i) { lua_pushnumber(lua, b.mass[i]); }}};

template <class Host>
int push_reading(lua_State* lua, std::span<const Reading<Host>> readings, const Host& host, std::uint32_t i, std::string_view name)
{
    for (const Reading<Host>& r : readings)
        if (name == r.value.name) return r.push(lua, host, i), 1;
    return 0;
}

int push_field(lua_State* lua, const Call& call, Ref ref, std::string_view name)
{
    if (ref.facet == Facet::Shaft) return push_reading<Shafts>(lua, kShaftReadings, *call.shafts, ref.index, name);
    if (ref.facet == Facet::Quantities) return push_reading<Quantities>(lua, kQuantitiesReadings, *call.quantities, ref.index, name);
    return push_reading<Bodies>(lua, kBodyReadings, *call.bodies, ref.index, name);
}

int participant_index(lua_State* lua)
{
    const auto& p = *static_cast<ParticipantObject*>(lua_touserdata(lua, 1));
    if (lua_type(lua, 2) == LUA_TSTRING)
    {
        std::size_t n = 0;
        const char* s = lua_tolstring(lua, 2, &n);
        const std::string_view name(s, n);
        if (!name.starts_with("add_"))
        {
            const Call& call = readable(lua, p);
            if (push_field(lua, call, p.ref, name)) return 1;
        }
        lua_pushvalue(lua, 2);
        if (lua_rawget(lua, lua_upvalueindex(1)) != LUA_TNIL) return 1;
    }
    return luaL_error(lua,
                      "%s has no '%s'; a shaft has angle, speed, inertia, a body has position, velocity, "
                      "angular_velocity, orientation, mass, quantities have count and value(i); "
                      "in force: add_force, add_force_at, add_torque, add_rate",
                      RoleName(p.place).text, lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : type_name(lua, 2));
}

int refuse_participant_assignment(lua_State* lua)
{
    return luaL_error(lua, "participants are read-only: add forces in force(t, state), or change parameters by set()");
}

/// The participant at argument 1, if this call may add forces to it.
const ParticipantObject& check_target(lua_State* lua)
{
    const auto* p = to_object<ParticipantObject>(lua, 1, Tag::Participant);
    if (!p) luaL_typeerror(lua, 1, "participant");
    const Call& call = readable(lua, *p);
    if (call.entry != EntryPoint::Force) luaL_error(lua, "forces are added in force(t, state), not in drive");
    if (p->place == kDriverPlace) luaL_error(lua, "driver is only read: forces are added to driven and between");
    return *p;
}

const ParticipantObject& check_body_target(lua_State* lua)
{
    const ParticipantObject& p = check_target(lua);
    if (p.ref.facet == Facet::Shaft) luaL_error(lua, "%s is a shaft: it takes add_torque(number)", RoleName(p.place).text);
    if (p.ref.facet == Facet::Quantities) luaL_error(lua, "%s are quantities: they take add_rate(i, number)", RoleName(p.place).text);
    return p;
}

const Vec3& check_finite(lua_State* lua, const ParticipantObject& p, int argument, const char* what)
{
    const Vec3& v = check_vector(lua, argument);
    if (!is_finite(v)) luaL_error(lua, "%s on %s is not finite", what, RoleName(p.place).text);
    return v;
}

int act(lua_State* lua, const Action& action)
{
    session_of(lua).actions.push_back(action);
    return 0;
}

int add_force(lua_State* lua)
{
    charge(lua, 1);
    const ParticipantObject& p = check_body_target(lua);
    return act(lua, {Action::Kind::Force, p.ref, check_finite(lua, p, 2, "force"), {}, 0});
}

int add_force_at(lua_State* lua)
{
    charge(lua, 1);
    const ParticipantObject& p = check_body_target(lua);
    const Vec3& force = check_finite(lua, p, 2, "force");
    return act(lua, {Action::Kind::ForceAt, p.ref, force, check_finite(lua, p, 3, "point of the force"), 0});
}

int add_torque(lua_State* lua)
{
    charge(lua, 1);
    const ParticipantObject& p = check_target(lua);
    if (p.ref.facet != Facet::Shaft)
    {
        const ParticipantObject& body = check_body_target(lua);
        return act(lua, {Action::Kind::Torque, body.ref, check_finite(lua, body, 2, "torque"), {}, 0});
    }
    const double torque = luaL_checknumber(lua, 2);
    if (!std::isfinite(torque)) return luaL_error(lua, "torque on %s is not finite", RoleName(p.place).text);
    return act(lua, {Action::Kind::ShaftTorque, p.ref, {torque, 0, 0}, {}, 0});
}

/// The index (from 0) of the value of quantities that argument 2 names (from 1).
std::uint32_t check_place(lua_State* lua, const Call& call, const ParticipantObject& p)
{
    if (p.ref.facet != Facet::Quantities) luaL_error(lua, "%s has no numbered values: those are quantities", RoleName(p.place).text);
    const lua_Integer i = luaL_checkinteger(lua, 2);
    const auto count = static_cast<lua_Integer>(call.quantities->value[p.ref.index].size());
    if (i < 1 || i > count) luaL_error(lua, "%s has values 1 to %I, not %I", RoleName(p.place).text, count, i);
    return static_cast<std::uint32_t>(i - 1);
}

int value_of(lua_State* lua)
{
    charge(lua, 1);
    const auto* p = to_object<ParticipantObject>(lua, 1, Tag::Participant);
    if (!p) return luaL_typeerror(lua, 1, "participant");
    const Call& call = readable(lua, *p);
    const std::uint32_t place = check_place(lua, call, *p);
    lua_pushnumber(lua, call.quantities->value[p->ref.index][place]);
    return 1;
}

int add_rate(lua_State* lua)
{
    charge(lua, 1);
    const ParticipantObject& p = check_target(lua);
    const std::uint32_t place = check_place(lua, readable(lua, p), p);
    const double rate = luaL_checknumber(lua, 3);
    if (!std::isfinite(rate)) return luaL_error(lua, "rate of %s is not finite", RoleName(p.place).text);
    return act(lua, {Action::Kind::Rate, p.ref, {rate, 0, 0}, {}, place});
}

constexpr NativeFunction kMethods[] = {
    {"add_force", add_force, "(force)", "of a body, in force: N, at the centre of mass, in the world"},
    {"add_force_at", add_force_at, "(force, point)", "of a body, in force: N, at a point of the world, m"},
    {"add_torque", add_torque, "(torque)", "of a body, in force: a vector, N m, in the world; of a shaft: a number, N m"},
    {"value", value_of, "(i)", "of quantities: the ith, from 1"},
    {"add_rate", add_rate, "(i, rate)", "of quantities, in force: z_i' is the sum of the rates, per s"}};

template <class Host>
std::vector<NativeValue> values_of(std::span<const Reading<Host>> readings)
{
    std::vector<NativeValue> out;
    for (const Reading<Host>& r : readings) out.push_back(r.value);
    return out;
}

/// Sets the global `name` to the object in `slot`, or to nil if there is no participant.
void bind_one(lua_State* lua, int slot, const char* name, Ref ref)
{
    lua_rawgeti(lua, LUA_REGISTRYINDEX, kGlobals);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, slot);
    static_cast<ParticipantObject*>(lua_touserdata(lua, -1))->ref = ref;
    if (!ref.valid())
    {
        lua_pop(lua, 1);
        lua_pushnil(lua);
    }
    lua_setfield(lua, -2, name);
    lua_pop(lua, 1);
}

void push_participant(lua_State* lua, int place, Ref ref)
{
    auto& p = push_object<ParticipantObject>(lua, Tag::Participant);
    p.place = place, p.ref = ref;
    lua_rawgeti(lua, LUA_REGISTRYINDEX, kParticipantMeta);
    lua_setmetatable(lua, -2);
}

void bind_list(lua_State* lua, const RefList& members)
{
    lua_rawgeti(lua, LUA_REGISTRYINDEX, kBetween);
    const auto before = static_cast<int>(lua_rawlen(lua, -1)), after = static_cast<int>(members.size());
    for (int i = 1; i <= after; ++i)
    {
        const Ref ref = members[static_cast<std::size_t>(i - 1)];
        if (lua_rawgeti(lua, -1, i) != LUA_TNIL)
            static_cast<ParticipantObject*>(lua_touserdata(lua, -1))->ref = ref;
        else
        {
            push_participant(lua, i, ref);
            lua_rawseti(lua, -3, i);
        }
        lua_pop(lua, 1);
    }
    for (int i = before; i > after; --i)
    {
        lua_rawgeti(lua, -1, i);
        static_cast<ParticipantObject*>(lua_touserdata(lua, -1))->ref = {};
        lua_pop(lua, 1);
        lua_pushnil(lua);
        lua_rawseti(lua, -2, i);
    }
    lua_pop(lua, 1);
}

}  // namespace

void bind_participants(lua_State* lua, const Call& call)
{
    Session& session = session_of(lua);
    bind_one(lua, kDriver, "driver", call.driver);
    bind_one(lua, kDriven, "driven", call.driven);
    bind_list(lua, *call.between);
    session.driver = call.driver, session.driven = call.driven, session.between = *call.between;
}

std::vector<NativeGroup> participant_groups()
{
    return {{"body", {}, values_of<Bodies>(kBodyReadings)},
            {"shaft", {}, values_of<Shafts>(kShaftReadings)},
            {"quantities", {}, values_of<Quantities>(kQuantitiesReadings)},
            {"participant", kMethods}};
}

void open_participants(lua_State* lua)
{
    lua_newtable(lua);
    lua_newtable(lua);
    add_functions(lua, kMethods);
    lua_pushcclosure(lua, participant_index, 1);
    lua_setfield(lua, -2, "__index");
    lua_pushcfunction(lua, refuse_participant_assignment);
    lua_setfield(lua, -2, "__newindex");
    lua_pushliteral(lua, "participant");
    lua_setfield(lua, -2, "__name");
    lua_rawseti(lua, LUA_REGISTRYINDEX, kParticipantMeta);

    push_participant(lua, kDriverPlace, {});
    lua_rawseti(lua, LUA_REGISTRYINDEX, kDriver);
    push_participant(lua, kDrivenPlace, {});
    lua_rawseti(lua, LUA_REGISTRYINDEX, kDriven);

    lua_newtable(lua);
    freeze_table(lua, -1);
    push_content(lua, lua_gettop(lua));
    lua_rawseti(lua, LUA_REGISTRYINDEX, kBetween);
    lua_setfield(lua, -2, "between");
}

}  // namespace plab::scripts
