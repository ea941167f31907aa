#include "import/collision_rules.h"

#include <algorithm>
#include <map>
#include <set>

namespace plab::import
{
namespace
{

using Members = std::vector<CollisionMember>;

class Rules
{
public:
    Rules(const Robot& robot, Assembly& assembly, Document& document) : robot_(robot), assembly_(assembly), document_(document) {}

    std::vector<CollisionExclusion> run()
    {
        find_pairs();
        if (document_.failed()) return {};
        exclude_by_masks();
        exclude_neighbours();
        exclude_models();
        for (const ExcludedBodies& e : robot_.exclusions) exclude(e);
        exclude_seen_planes();
        return std::move(out_);
    }

private:
    /// Shapes of equal masks. A shape of a pair is a class of its own.
    struct Class
    {
        std::uint32_t type = 0, affinity = 0;
        Members members;
        bool paired = false;
    };
    using Shape = std::pair<std::size_t, std::size_t>;  ///< body, shape

    /// One exclusion for each class has to hold the members of all others.
    static constexpr std::size_t kMostClasses = 512;

    PlacedBody& body(std::size_t i) { return assembly_.bodies[i]; }
    bool collides(std::size_t i) { return std::ranges::any_of(body(i).shapes, &RobotShape::collides); }

    // ---- pairs, which collide whatever else is said

    void find_pairs()
    {
        if (robot_.pairs.empty()) return;
        std::map<std::string, Shape> shapes;
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
            for (std::size_t k = 0; k < body(i).shapes.size(); ++k)
                if (const RobotShape& s = body(i).shapes[k]; !s.name.empty()) shapes[s.name] = {i, k};
        for (const CollidingPair& pair : robot_.pairs)
        {
            const auto one = shapes.find(pair.first), other = shapes.find(pair.second);
            if (one == shapes.end() || other == shapes.end())
            {
                document_.error(pair.where, "<pair>", "there is no geom '" + (one == shapes.end() ? pair.first : pair.second) + "'");
                continue;
            }
            for (const auto& [i, k] : {one->second, other->second}) body(i).shapes[k].collides = true;
            partners_[one->second].insert(other->second), partners_[other->second].insert(one->second);
        }
    }

    bool is_pair(const Shape& s, const Shape& t) const
    {
        const auto found = partners_.find(s);
        return found != partners_.end() && found->second.contains(t);
    }

    bool has_pair(std::size_t a, std::size_t b)
    {
        for (std::size_t k = 0; !partners_.empty() && k < body(a).shapes.size(); ++k)
            if (const auto found = partners_.find({a, k}); found != partners_.end())
                if (std::ranges::any_of(found->second, [&](const Shape& s) { return s.first == b; })) return true;
        return false;
    }

    // ---- masks: contype and conaffinity

    std::vector<Class> classes_of_shapes()
    {
        std::vector<Class> classes;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> known;
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
            for (std::size_t k = 0; k < body(i).shapes.size(); ++k)
            {
                const RobotShape& s = body(i).shapes[k];
                if (!s.collides) continue;
                const bool paired = partners_.contains({i, k});
                std::size_t number = classes.size();
                if (!paired) number = known.emplace(std::pair(s.contact_type, s.contact_affinity), number).first->second;
                if (number == classes.size()) classes.push_back({s.contact_type, s.contact_affinity, {}, paired});
                classes[number].members.push_back({i, k});
            }
        return classes;
    }

    bool matches(const Class& a, const Class& b) const
    {
        if ((a.type & b.affinity) != 0 || (b.type & a.affinity) != 0) return true;
        if (!a.paired || !b.paired) return false;
        return is_pair({a.members.front().body, a.members.front().shape}, {b.members.front().body, b.members.front().shape});
    }

    static bool several_bodies(const Class& c)
    {
        return std::ranges::any_of(c.members, [&](const CollisionMember& m) { return m.body != c.members.front().body; });
    }

    /// The file has only one body to touch. It still collides with what is added to the scene, unless its masks are 0.
    bool stand_alone(const std::vector<Class>& classes)
    {
        const auto elsewhere = [&](const Class& c)
        { return several_bodies(c) || c.members.front().body != classes.front().members.front().body; };
        if (std::ranges::any_of(classes, elsewhere)) return false;
        for (const Class& c : classes)
            for (const CollisionMember& m : c.members)
                if (c.type == 0 && c.affinity == 0) body(m.body).shapes[m.shape].collides = false;
        return true;
    }

    void exclude_by_masks()
    {
        const std::vector<Class> classes = classes_of_shapes();
        if (stand_alone(classes)) return;
        if (classes.size() > kMostClasses)
            return document_.lost(robot_.bodies.front().where, "contype, conaffinity",
                                  "have more than 512 different values: here each shape collides with each");
        std::vector<bool> lonely(classes.size());
        for (std::size_t i = 0; i < classes.size(); ++i) lonely[i] = !meets_any(classes, i);
        for (std::size_t i = 0; i < classes.size(); ++i)
            for (const CollisionMember& m : classes[i].members)
                if (lonely[i]) body(m.body).shapes[m.shape].collides = false;
        for (std::size_t i = 0; i < classes.size(); ++i)
        {
            if (lonely[i]) continue;
            if (!matches(classes[i], classes[i]) && several_bodies(classes[i])) out_.push_back({joined(classes[i].members), {}, {}});
            Members others;
            for (std::size_t j = i + 1; j < classes.size(); ++j)
                if (!lonely[j] && !matches(classes[i], classes[j]))
                    others.insert(others.end(), classes[j].members.begin(), classes[j].members.end());
            if (!others.empty()) out_.push_back({{}, joined(classes[i].members), joined(std::move(others))});
        }
    }

    bool meets_any(const std::vector<Class>& classes, std::size_t i) const
    {
        for (std::size_t j = 0; j < classes.size(); ++j)
            if (matches(classes[i], classes[j]) && (j != i || several_bodies(classes[i]))) return true;
        return false;
    }

    /// Bodies instead of shapes, where all shapes of a body that collide are there.
    Members joined(Members members)
    {
        std::map<std::size_t, std::vector<std::size_t>> of_body;
        for (const CollisionMember& m : members) of_body[m.body].push_back(m.shape);
        Members out;
        for (const auto& [i, shapes] : of_body)
            if (std::ranges::count_if(body(i).shapes, &RobotShape::collides) == std::ssize(shapes))
                out.push_back({i});
            else
                for (const std::size_t k : shapes) out.push_back({i, k});
        return out;
    }

    // ---- parent and child

    void exclude_neighbours()
    {
        std::map<std::size_t, Members> children;
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
        {
            const std::size_t parent = body(i).parent;
            if (parent == kWorld || body(i).fixed || (robot_.fixed_parents_collide && body(parent).fixed)) continue;
            if (!collides(i) || !collides(parent) || one_model(i, parent)) continue;
            if (has_pair(parent, i))
                exclude_but_pairs(all_of(parent), all_of(i));
            else
                children[parent].push_back({i});
        }
        for (auto& [parent, members] : children) out_.push_back({{}, {{parent}}, std::move(members)});
    }

    Members all_of(std::size_t i)
    {
        Members out;
        for (std::size_t k = 0; k < body(i).shapes.size(); ++k)
            if (body(i).shapes[k].collides) out.push_back({i, k});
        return out;
    }

    void exclude_but_pairs(const Members& a, const Members& b)
    {
        for (const CollisionMember& m : a)
        {
            Members others;
            std::ranges::copy_if(b, std::back_inserter(others),
                                 [&](const CollisionMember& n) {
                                     return !is_pair({m.body, m.shape}, {n.body, n.shape});
                                 });
            if (!others.empty()) out_.push_back({{}, {m}, std::move(others)});
        }
    }

    // ---- the links of a model that do not collide with one another

    bool one_model(std::size_t i, std::size_t j)
    {
        return !body(i).self_collide && !body(j).self_collide && body(i).model == body(j).model;
    }

    void exclude_models()
    {
        std::map<std::size_t, Members> models;
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
            if (!body(i).self_collide && collides(i)) models[body(i).model].push_back({i});
        for (auto& [model, members] : models)
            if (std::ranges::any_of(members, [&](const CollisionMember& m) { return !body(m.body).fixed; }) && members.size() > 1)
                out_.push_back({std::move(members), {}, {}});
    }

    // ---- exclusions by name

    /// The shapes that the file's body has brought to the one that it is a part of.
    Members shapes_of(const std::string& name)
    {
        Members out;
        const std::size_t i = assembly_.frames.at(name).body;
        for (const CollisionMember& m : all_of(i))
            if (body(i).shapes[m.shape].owner == name) out.push_back(m);
        return out;
    }

    void exclude(const ExcludedBodies& e)
    {
        for (const std::string& name : {e.first, e.second})
            if (!assembly_.frames.contains(name)) return document_.error(e.where, "<exclude>", "there is no body '" + name + "'");
        Members a = shapes_of(e.first), b = shapes_of(e.second);
        if (a.empty() || b.empty() || a.front().body == b.front().body) return;
        if (has_pair(a.front().body, b.front().body)) return exclude_but_pairs(a, b);
        out_.push_back({{}, joined(std::move(a)), joined(std::move(b))});
    }

    /// pLab has no plane that is only seen.
    void exclude_seen_planes()
    {
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
            for (std::size_t k = 0; k < body(i).shapes.size(); ++k)
                if (body(i).shapes[k].kind == ShapeKind::Plane && !body(i).shapes[k].collides && collides(i)) exclude_from_all(i, k);
    }

    void exclude_from_all(std::size_t i, std::size_t k)
    {
        Members others;
        for (std::size_t j = 0; j < assembly_.bodies.size(); ++j)
            if (j != i && collides(j)) others.push_back({j});
        if (!others.empty()) out_.push_back({{}, {{i, k}}, std::move(others)});
    }

    const Robot& robot_;
    Assembly& assembly_;
    Document& document_;
    std::map<Shape, std::set<Shape>> partners_;
    std::vector<CollisionExclusion> out_;
};

}  // namespace

std::vector<CollisionExclusion> collision_rules(const Robot& robot, Assembly& assembly, Document& document)
{
    return Rules(robot, assembly, document).run();
}

}  // namespace plab::import
