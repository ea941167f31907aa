/// A scene, resolved and checked: a flat list of components with values, roles and the commands that take part. The world is
/// built only from this form; requests add to it and remove from it, --expand prints it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::model
{

/// A step length, exact if the text was: 1/240, 0.001 (= 1/1000). seconds == numerator / denominator.
struct StepLength
{
    double seconds = 1.0 / 240;
    std::int64_t numerator = 1;
    std::int64_t denominator = 240;  ///< 0: only `seconds` is known
    /// n * dt with one rounding.
    double at(std::int64_t n) const
    {
        return denominator > 0 ? static_cast<double>(n * numerator) / static_cast<double>(denominator) : static_cast<double>(n) * seconds;
    }
};

struct Camera
{
    std::string name;
    Vec3 position{4, -6, 3};
    Vec3 look_at;
    Vec3 up{0, 0, 1};
    double field_of_view = 0.7;  ///< rad, vertical
};

struct SceneSettings
{
    StepLength dt;
    std::uint64_t seed = 1;
    std::string solver = "solver";                 ///< id of the solver of objects that name none
    std::string solver_type = "Solver/Automatic";  ///< its type, if the scene has no component with that id
    std::string title;
    std::vector<Camera> cameras;
};

struct FieldSpec
{
    std::string name;
    Value value;
    SourceLocation where;
};

struct RoleSpec
{
    std::string name;
    std::vector<std::string> members;  ///< ids of typed components with a facet that the role accepts, in id order
    bool everyone = false;             ///< all that fit take part, including those added later: "*", or those of `patterns`
    SourceLocation where;
    std::vector<std::string> patterns = {};  ///< with `everyone`: ids, and patterns of ids, of which one must match; none: "*"
};

struct ComponentSpec
{
    std::string id;
    std::string name;                ///< display name
    std::string type;                ///< empty: a group
    std::string parent;              ///< id; empty at top level
    std::string alias_of;            ///< compref: shares that component; then type is empty
    std::vector<std::string> group;  ///< comprefs of a group without type, when there are several
    std::vector<FieldSpec> fields;   ///< fields that the author gave; the rest have the declared defaults
    std::vector<RoleSpec> roles;
    bool explicit_commands = false;     ///< a simulation command selects: only `commands` take part
    std::vector<std::string> commands;  ///< names of exported commands that take part
    bool generated = false;             ///< generated because the short form left it out
    std::string made_by;                ///< id of the component that asked for it (Phase::Decide); empty: an author or a client
    SourceLocation where;
};

/// The components of a scene in the order of its document. Copies share the components, which never change: a change replaces one by
/// another. So a scene with one component exchanged costs a pointer for each of the others, and copies may be used by other threads.
class ComponentList
{
public:
    class Iterator
    {
    public:
        using iterator_category = std::random_access_iterator_tag;
        using value_type = ComponentSpec;
        using difference_type = std::ptrdiff_t;
        using pointer = const ComponentSpec*;
        using reference = const ComponentSpec&;

        Iterator() = default;
        explicit Iterator(const std::shared_ptr<const ComponentSpec>* at) : at_(at) {}
        reference operator*() const { return **at_; }
        pointer operator->() const { return at_->get(); }
        reference operator[](difference_type n) const { return *at_[n]; }
        Iterator& operator++() { return ++at_, *this; }
        Iterator& operator--() { return --at_, *this; }
        Iterator operator++(int) { return Iterator(at_++); }
        Iterator& operator+=(difference_type n) { return at_ += n, *this; }
        friend Iterator operator+(Iterator i, difference_type n) { return Iterator(i.at_ + n); }
        friend Iterator operator-(Iterator i, difference_type n) { return Iterator(i.at_ - n); }
        friend difference_type operator-(Iterator a, Iterator b) { return a.at_ - b.at_; }
        friend auto operator<=>(const Iterator&, const Iterator&) = default;

    private:
        const std::shared_ptr<const ComponentSpec>* at_ = nullptr;
    };

    ComponentList() = default;
    ComponentList(std::vector<ComponentSpec> specs)
    {
        reserve(specs.size());
        for (ComponentSpec& spec : specs) push_back(std::move(spec));
    }

    Iterator begin() const { return Iterator(specs_.data()); }
    Iterator end() const { return Iterator(specs_.data() + specs_.size()); }
    std::size_t size() const { return specs_.size(); }
    bool empty() const { return specs_.empty(); }
    const ComponentSpec& operator[](std::size_t i) const { return *specs_[i]; }
    const ComponentSpec& front() const { return *specs_.front(); }
    const ComponentSpec& back() const { return *specs_.back(); }

    void reserve(std::size_t n) { specs_.reserve(n); }
    void push_back(ComponentSpec spec) { specs_.push_back(std::make_shared<const ComponentSpec>(std::move(spec))); }
    void append(const ComponentList& others) { specs_.insert(specs_.end(), others.specs_.begin(), others.specs_.end()); }
    void replace(std::size_t i, ComponentSpec spec) { specs_[i] = std::make_shared<const ComponentSpec>(std::move(spec)); }
    /// The component as it is, to be put back by the second form of replace().
    std::shared_ptr<const ComponentSpec> share(std::size_t i) const { return specs_[i]; }
    void replace(std::size_t i, std::shared_ptr<const ComponentSpec> spec) { specs_[i] = std::move(spec); }
    template <class Gone>
    void remove_if(Gone gone)
    {
        std::erase_if(specs_, [&](const std::shared_ptr<const ComponentSpec>& spec) { return gone(*spec); });
    }

private:
    std::vector<std::shared_ptr<const ComponentSpec>> specs_;
};

struct SceneSpec
{
    SceneSettings settings;
    ComponentList components;  ///< document order; ids unique
    std::string file;

    const ComponentSpec* find(const std::string& id) const
    {
        const std::size_t i = position_of(id, 0);
        return i < components.size() ? &components[i] : nullptr;
    }
    /// Where the component is; `guess` is looked at first. The number of components if there is none with this id.
    std::size_t position_of(const std::string& id, std::size_t guess) const
    {
        if (guess < components.size() && components[guess].id == id) return guess;
        std::size_t i = 0;
        while (i < components.size() && components[i].id != id) ++i;
        return i;
    }
};

}  // namespace plab::model
