// Vectors and rotations: immutable values, so that keeping one across calls carries no state.
#include <cstdio>
#include <new>

#include "lua/native.h"

namespace plab::scripts
{
namespace
{

struct VectorObject : Object
{
    Vec3 v;
};

struct RotationObject : Object
{
    Quat q;
};

int make_vector(lua_State* lua)
{
    push_vector(lua, {luaL_checknumber(lua, 1), luaL_checknumber(lua, 2), luaL_checknumber(lua, 3)});
    return 1;
}

/// Both arguments; the first is always checked first, whatever the evaluation order of arguments.
struct Operands
{
    explicit Operands(lua_State* lua) : a(check_vector(lua, 1)), b(check_vector(lua, 2)) {}
    const Vec3 &a, &b;
};

int vector_add(lua_State* lua)
{
    const Operands of(lua);
    return push_vector(lua, of.a + of.b), 1;
}
int vector_subtract(lua_State* lua)
{
    const Operands of(lua);
    return push_vector(lua, of.a - of.b), 1;
}
int vector_negate(lua_State* lua) { return push_vector(lua, -check_vector(lua, 1)), 1; }
int vector_divide(lua_State* lua)
{
    const Vec3& v = check_vector(lua, 1);
    return push_vector(lua, v / luaL_checknumber(lua, 2)), 1;
}
int vector_multiply(lua_State* lua)
{
    const Vec3 *a = to_vector(lua, 1), *b = to_vector(lua, 2);
    if (a && b) return luaL_error(lua, "vec * vec is neither: use a:dot(b) or a:cross(b)");
    push_vector(lua, a ? *a * luaL_checknumber(lua, 2) : check_vector(lua, 2) * luaL_checknumber(lua, 1));
    return 1;
}
int vector_equal(lua_State* lua)
{
    const Vec3 *a = to_vector(lua, 1), *b = to_vector(lua, 2);
    lua_pushboolean(lua, a && b && *a == *b);
    return 1;
}
int vector_dot(lua_State* lua)
{
    const Operands of(lua);
    return lua_pushnumber(lua, dot(of.a, of.b)), 1;
}
int vector_cross(lua_State* lua)
{
    const Operands of(lua);
    return push_vector(lua, cross(of.a, of.b)), 1;
}
int vector_length(lua_State* lua) { return lua_pushnumber(lua, length(check_vector(lua, 1))), 1; }
int vector_normalized(lua_State* lua) { return push_vector(lua, normalized(check_vector(lua, 1))), 1; }

int rotation_rotate(lua_State* lua, Vec3 (*turn)(const Quat&, const Vec3&))
{
    const auto* r = to_object<RotationObject>(lua, 1, Tag::Rotation);
    luaL_argexpected(lua, r, 1, "rotation");
    push_vector(lua, turn(r->q, check_vector(lua, 2)));
    return 1;
}
int rotation_forth(lua_State* lua) { return rotation_rotate(lua, rotate); }
int rotation_back(lua_State* lua) { return rotation_rotate(lua, rotate_back); }

/// A method from the table that is this function's upvalue.
int find_method(lua_State* lua, const char* what)
{
    lua_pushvalue(lua, 2);
    if (lua_rawget(lua, lua_upvalueindex(1)) != LUA_TNIL) return 1;
    return luaL_error(lua, "%s has no '%s'", what, lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : type_name(lua, 2));
}

/// The only character of the key, or 0.
char letter_of(lua_State* lua)
{
    if (lua_type(lua, 2) != LUA_TSTRING) return 0;
    const char* key = lua_tostring(lua, 2);
    return key[0] != 0 && key[1] == 0 ? key[0] : '\0';
}

int vector_index(lua_State* lua)
{
    const Vec3& v = check_vector(lua, 1);
    switch (letter_of(lua))
    {
        case 'x':
            return lua_pushnumber(lua, v.x), 1;
        case 'y':
            return lua_pushnumber(lua, v.y), 1;
        case 'z':
            return lua_pushnumber(lua, v.z), 1;
        default:
            return find_method(lua, "vec");
    }
}

int rotation_index(lua_State* lua)
{
    const Quat& q = static_cast<RotationObject*>(lua_touserdata(lua, 1))->q;
    switch (letter_of(lua))
    {
        case 'w':
            return lua_pushnumber(lua, q.w), 1;
        case 'x':
            return lua_pushnumber(lua, q.x), 1;
        case 'y':
            return lua_pushnumber(lua, q.y), 1;
        case 'z':
            return lua_pushnumber(lua, q.z), 1;
        default:
            return find_method(lua, "a rotation");
    }
}

int refuse_vector_assignment(lua_State* lua) { return luaL_error(lua, "a %s does not change: make a new one", type_name(lua, 1)); }

constexpr NativeFunction kMakers[] = {{"vec", make_vector, "(x, y, z)", "a vector; `+ - ==`, `-v`, `*` and `/` with a number"}};
constexpr NativeFunction kVectorMethods[] = {{"dot", vector_dot, "(other)", "scalar product"},
                                             {"cross", vector_cross, "(other)", "vector product"},
                                             {"length", vector_length, "()", "as the vector's unit"},
                                             {"normalized", vector_normalized, "()", "of length 1"}};
constexpr NativeValue kVectorValues[] = {{"x", "", "component"}, {"y", "", "component"}, {"z", "", "component"}};
constexpr NativeFunction kVectorOperators[] = {{"__add", vector_add},
                                               {"__sub", vector_subtract},
                                               {"__mul", vector_multiply},
                                               {"__div", vector_divide},
                                               {"__unm", vector_negate},
                                               {"__eq", vector_equal},
                                               {"__newindex", refuse_vector_assignment}};
constexpr NativeFunction kRotationMethods[] = {{"rotate", rotation_forth, "(vector)", "from the body's axes to the world's"},
                                               {"rotate_back", rotation_back, "(vector)", "from the world's axes to the body's"}};
constexpr NativeValue kRotationValues[] = {
    {"w", "", "scalar part"}, {"x", "", "component"}, {"y", "", "component"}, {"z", "", "component"}};
constexpr NativeFunction kRotationOperators[] = {{"__newindex", refuse_vector_assignment}};

void make_metatable(lua_State* lua, int slot, const char* name, std::span<const NativeFunction> operators,
                    std::span<const NativeFunction> methods, lua_CFunction index)
{
    lua_newtable(lua);
    add_functions(lua, operators);
    lua_newtable(lua);
    add_functions(lua, methods);
    lua_pushcclosure(lua, index, 1);
    lua_setfield(lua, -2, "__index");
    lua_pushstring(lua, name);
    lua_setfield(lua, -2, "__name");
    lua_rawseti(lua, LUA_REGISTRYINDEX, slot);
}

}  // namespace

void push_vector(lua_State* lua, const Vec3& v)
{
    push_object<VectorObject>(lua, Tag::Vector).v = v;
    lua_rawgeti(lua, LUA_REGISTRYINDEX, kVectorMeta);
    lua_setmetatable(lua, -2);
}

const Vec3* to_vector(lua_State* lua, int index)
{
    const auto* object = to_object<VectorObject>(lua, index, Tag::Vector);
    return object ? &object->v : nullptr;
}

const Vec3& check_vector(lua_State* lua, int argument)
{
    const Vec3* v = to_vector(lua, argument);
    if (!v) luaL_typeerror(lua, argument, "vec");  // does not return
    return *v;
}

void push_rotation(lua_State* lua, const Quat& q)
{
    push_object<RotationObject>(lua, Tag::Rotation).q = q;
    lua_rawgeti(lua, LUA_REGISTRYINDEX, kRotationMeta);
    lua_setmetatable(lua, -2);
}

std::vector<NativeGroup> vector_groups()
{
    return {{"", kMakers},
            {"vector", kVectorMethods, {std::begin(kVectorValues), std::end(kVectorValues)}},
            {"orientation", kRotationMethods, {std::begin(kRotationValues), std::end(kRotationValues)}}};
}

void open_vectors(lua_State* lua)
{
    make_metatable(lua, kVectorMeta, "vec", kVectorOperators, kVectorMethods, vector_index);
    make_metatable(lua, kRotationMeta, "rotation", kRotationOperators, kRotationMethods, rotation_index);
    add_functions(lua, kMakers);
}

}  // namespace plab::scripts
