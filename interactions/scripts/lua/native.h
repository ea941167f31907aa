/// The functions and objects that scripts can use, by file. Each open_ function adds to the table on top of the stack.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lua/session.h"
#include "plab/vector.h"

namespace plab::scripts
{

/// A function, as it is registered and as the reference manual lists it.
struct NativeFunction
{
    const char* name;
    lua_CFunction call;
    const char* arguments = "";  ///< "(force)", with units in `meaning`
    const char* meaning = "";
};

/// A value that can be read by name, for the manual.
struct NativeValue
{
    const char* name;
    const char* unit;
    const char* meaning;
};

void add_functions(lua_State* lua, std::span<const NativeFunction> functions);

/// base.cpp: pcall, xpcall, error, assert, select, type, tostring, tonumber, ipairs, pairs
void open_base(lua_State* lua);
/// effects.cpp: set, emit, print
void open_effects(lua_State* lua);
/// math_library.cpp, string_library.cpp, table_library.cpp: each adds its library as one read-only field.
void open_math(lua_State* lua);
void open_string(lua_State* lua);
void open_table(lua_State* lua);
/// vectors.cpp: vec, and the metatables of vectors and rotations
void open_vectors(lua_State* lua);
/// participants.cpp: the metatable of driver, driven, between[i]
void open_participants(lua_State* lua);
/// records.cpp: state, parameters, and step in the registry
void open_records(lua_State* lua);

/// What these files register, by prefix in a script ("math.", "body:", ...; "" for globals); manual.cpp prints it.
struct NativeGroup
{
    const char* prefix;
    std::span<const NativeFunction> functions;
    std::vector<NativeValue> values = {};
};
NativeGroup base_group();
NativeGroup effects_group();
NativeGroup math_group();
NativeGroup string_group();
NativeGroup table_group();
std::vector<NativeGroup> vector_groups();
std::vector<NativeGroup> participant_groups();
NativeGroup step_group();

// Objects: every userdata of a machine starts with a tag, so that wrong arguments are detected at almost no cost.

enum class Tag : std::uint32_t
{
    Vector,
    Rotation,
    Participant,
    State,
    Parameters,
    Step,
};

struct Object
{
    Tag tag;
};

/// Pushes a new object without a metatable.
template <class T>
T& push_object(lua_State* lua, Tag tag)
{
    T* object = new (lua_newuserdatauv(lua, sizeof(T), 0)) T;
    object->tag = tag;
    return *object;
}
/// The object at `index`, or null if it does not have that tag.
template <class T>
T* to_object(lua_State* lua, int index, Tag tag)
{
    auto* object = static_cast<Object*>(lua_touserdata(lua, index));
    return object && object->tag == tag ? static_cast<T*>(object) : nullptr;
}

void push_vector(lua_State* lua, const Vec3& v);
const Vec3* to_vector(lua_State* lua, int index);
const Vec3& check_vector(lua_State* lua, int argument);
void push_rotation(lua_State* lua, const Quat& q);

/// Sets driver, driven and between to those of the call. Needs some stack; raises an error when out of memory.
void bind_participants(lua_State* lua, const Call& call);

/// Like luaL_typename, but with the names of pLab's own objects.
const char* type_name(lua_State* lua, int index);

/// Pushes a string; raises an error if it is too long.
void push_text(lua_State* lua, std::string_view text);
/// The string at `argument`; its length is charged to the budget.
std::string_view check_text(lua_State* lua, int argument);

/// A string under construction, on the C++ stack, so that no call allocates for it.
class Text
{
public:
    void append(std::string_view part)
    {
        wanted_ += part.size();
        if (wanted_ <= kLongestText) part.copy(bytes_ + wanted_ - part.size(), part.size());
    }
    void append(char c) { append(std::string_view(&c, 1)); }
    bool fits() const { return wanted_ <= kLongestText; }
    std::size_t wanted() const { return wanted_; }
    std::string_view view() const { return {bytes_, fits() ? wanted_ : 0}; }

private:
    std::size_t wanted_ = 0;  // bytes, whether they fit or not
    char bytes_[kLongestText];
};

/// Pushes the string and charges for it; raises an error if it is too long.
void push_text(lua_State* lua, const Text& text);

/// Appends what tostring() shows; never an address.
void append_shown(lua_State* lua, int index, Text& out);

/// Whether the bytes are valid UTF-8, as required for everything that leaves as JSON or on the bus.
bool is_utf8(std::string_view text);

}  // namespace plab::scripts
