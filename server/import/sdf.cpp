#include "import/sdf.h"

#include <algorithm>
#include <map>
#include <memory>

#include "import/sdf_files.h"
#include "import/sdf_frames.h"
#include "import/sdf_joint.h"
#include "import/sdf_link.h"
#include "import/sdf_text.h"
#include "model/numbers.h"

namespace plab::import
{
namespace
{

class SdfReader
{
public:
    SdfReader(const std::vector<std::string>& folders, bool fixed_base, Document& document)
        : fixed_base_(fixed_base), document_(document), files_(folders, document), frames_(document)
    {
    }

    Robot read(const XmlElement& root)
    {
        document_.list_attributes(root, {"version"});
        document_.list_children(root, {"world", "model"});
        const double version = document_.number(root, "version", 1.7);
        const XmlElement* const world = find_child(root, "world");
        const XmlElement* const model = find_child(root, "model");
        if (!world && !model) document_.error(root, "has neither a <world> nor a <model>");
        if (world || model) document_.list_repeated(root, {});
        if (world && model) document_.lost(*model, "is not carried over: the world counts");
        robot_.base_collides = true;
        if (world) read_world(*world, version);
        if (!world && model) read_model(*model, "", version, {}, true, 0);
        if (!document_.failed()) read_links();
        if (!document_.failed()) read_joints();
        if (!document_.failed()) order();
        if (!document_.failed()) start_mimics();
        return std::move(robot_);
    }

private:
    /// What the models around a link say of it.
    struct ModelRules
    {
        bool is_static = false, self_collide = false;
        std::size_t model = 0;  ///< number of the outermost one
    };
    struct Link
    {
        const XmlElement* element;
        std::string scope, full;
        ModelRules rules;
        RobotBody body;
        std::size_t joint = kNone;          ///< to its parent
        std::vector<std::size_t> children;  ///< joints
    };
    struct ReadJoint
    {
        const XmlElement* element;
        std::string scope, full;
        double version;
    };
    static constexpr std::size_t kNone = std::size_t(-1), kMostLinks = 100'000, kMostModels = 20'000;
    static constexpr int kDeepest = 50;

    // ---- first the frames, as poses may name what follows

    void read_world(const XmlElement& e, double version)
    {
        robot_.title = document_.text(e, "name");
        document_.list_attributes(e, {"name"});
        document_.list_children(e, {"gravity", "physics", "model", "include", "frame"});
        robot_.gravity = sdf_vector(e, "gravity", {0, 0, -9.8}, document_);
        if (const XmlElement* const physics = find_child(e, "physics")) read_physics(*physics);
        for (const XmlElement& child : e.children)
            if (child.name == "model")
                read_model(child, "", version, {}, false, 0);
            else if (child.name == "include")
                read_include(child, "", version, {}, 0);
            else if (child.name == "frame")
                read_frame(child, "", "world");
    }

    void read_physics(const XmlElement& e)
    {
        document_.list_attributes(e, {"name", "default", "type"});
        document_.list_children(e, {"max_step_size"});
        const double step = sdf_number(e, "max_step_size", 0.001, document_);
        if (!(step >= 1e-9 && step <= 3600)) return document_.error(e, "max_step_size must be from 1e-9 s to 3600 s");
        robot_.step = model::format_real(step);
    }

    void read_include(const XmlElement& e, const std::string& scope, double version, ModelRules rules, int depth)
    {
        if (depth > kDeepest) return document_.error(e, "models are nested more than 50 deep");
        XmlElement model;
        if (!files_.include(e, model, version)) return;
        included_.push_back(std::make_unique<XmlElement>(std::move(model)));
        read_model(*included_.back(), scope, version, rules, false, depth + 1);
    }

    static std::string name_of(const XmlElement& e, Document& document)
    {
        const std::string name = document.text(e, "name");
        if (name.empty()) document.error(e, "needs a name");
        return name;
    }

    /// `alone`: the only model of the file, whose name its links do not need.
    void read_model(const XmlElement& e, const std::string& scope, double version, ModelRules rules, bool alone, int depth)
    {
        if (depth > kDeepest) return document_.error(e, "models are nested more than 50 deep");
        if (++models_ > kMostModels) return document_.error(e, "is one model too many: 20,000 are allowed");
        const std::string name = name_of(e, document_), full = SdfFrames::full_name(scope, name);
        if (name.empty()) return;
        if (alone) robot_.title = name, prefix_ = name + "::";
        document_.list_attributes(e, {"name", "canonical_link", "placement_frame"});
        document_.list_children(
            e, {"static", "pose", "link", "joint", "frame", "model", "include", "self_collide", "allow_auto_disable", "enable_wind"});
        if (sdf_truth(e, "enable_wind", false, document_)) document_.lost(*find_child(e, "enable_wind"), "is not carried over");
        rules.is_static = rules.is_static || sdf_truth(e, "static", false, document_);
        rules.self_collide = sdf_truth(e, "self_collide", rules.self_collide, document_);
        if (scope.empty()) rules.model = models_;
        SdfFrame frame = frame_of(e, scope);
        frame.is_model = true, frame.placement = document_.text(e, "placement_frame"), frame.attached_to = canonical_link(e);
        if (!frames_.add(full, std::move(frame))) return;
        read_parts(e, full, version, rules, depth);
    }

    void read_parts(const XmlElement& e, const std::string& full, double version, ModelRules rules, int depth)
    {
        for (const XmlElement& child : e.children)
            if (child.name == "link")
                add_link(child, full, rules);
            else if (child.name == "joint")
                add_joint(child, full, version);
            else if (child.name == "frame")
                read_frame(child, full, "__model__");
            else if (child.name == "model")
                read_model(child, full, version, rules, false, depth + 1);
            else if (child.name == "include")
                read_include(child, full, version, rules, depth + 1);
    }

    /// The named one, or the first link of the model or of the models in it.
    std::string canonical_link(const XmlElement& e)
    {
        if (const std::string given = document_.text(e, "canonical_link"); !given.empty()) return given;
        if (const XmlElement* const link = find_child(e, "link")) return document_.text(*link, "name");
        const XmlElement* const inner = find_child(e, "model");
        return inner ? document_.text(*inner, "name") : "world";
    }

    SdfFrame frame_of(const XmlElement& e, const std::string& scope)
    {
        const SdfPose given = sdf_pose(e, document_);
        SdfFrame frame;
        frame.scope = scope, frame.relative_to = given.relative_to, frame.pose = given.pose;
        frame.where = e.where, frame.element = Document::title_of(e);
        return frame;
    }

    void read_frame(const XmlElement& e, const std::string& scope, const char* otherwise)
    {
        document_.list_attributes(e, {"name", "attached_to"});
        document_.list_children(e, {"pose"});
        const std::string name = name_of(e, document_);
        if (name.empty()) return;
        SdfFrame frame = frame_of(e, scope);
        frame.attached_to = document_.text(e, "attached_to");
        if (frame.attached_to.empty()) frame.attached_to = otherwise;
        if (frame.relative_to.empty()) frame.relative_to = frame.attached_to;
        frames_.add(SdfFrames::full_name(scope, name), std::move(frame));
    }

    void add_link(const XmlElement& e, const std::string& scope, ModelRules rules)
    {
        const std::string name = name_of(e, document_), full = SdfFrames::full_name(scope, name);
        if (name.empty() || !frames_.add(full, frame_of(e, scope))) return;
        if (links_.size() >= kMostLinks) return document_.error(e, "is one link too many: 100,000 are allowed");
        numbers_[full] = links_.size();
        rules.self_collide = sdf_truth(e, "self_collide", rules.self_collide, document_);
        links_.push_back({&e, scope, full, rules, {}, kNone, {}});
    }

    void add_joint(const XmlElement& e, const std::string& scope, double version)
    {
        const std::string name = name_of(e, document_), full = SdfFrames::full_name(scope, name);
        if (name.empty()) return;
        SdfFrame frame = frame_of(e, scope);
        frame.attached_to = sdf_text(e, "child");
        if (frame.relative_to.empty()) frame.relative_to = frame.attached_to;
        if (frames_.add(full, std::move(frame))) joint_elements_.push_back({&e, scope, full, version});
    }

    // ---- then links and joints

    /// The only model of a file does not stand in the names of its parts.
    std::string shown(const std::string& full) const { return full.starts_with(prefix_) ? full.substr(prefix_.size()) : full; }

    void read_links()
    {
        for (Link& link : links_)
        {
            link.body = read_sdf_link(*link.element, link.scope, link.full, link.rules.is_static, frames_, files_, document_);
            link.body.name = shown(link.full), link.body.pose = frames_.in_world(link.full);
            link.body.free = !link.rules.is_static && !fixed_base_;
            link.body.self_collide = link.rules.self_collide, link.body.model = link.rules.model;
        }
    }

    /// The first joint of a link holds it to its parent; a further one, or one that would make a ring, closes a loop.
    void read_joints()
    {
        for (const ReadJoint& element : joint_elements_)
        {
            auto joint = read_sdf_joint(*element.element, element.scope, element.full, element.version, frames_, document_);
            if (!joint) continue;
            for (Joint& one : joint->joints) one.name = shown(one.name);
            mimics_.insert(mimics_.end(), joint->mimics.begin(), joint->mimics.end());
            Link& child = links_[numbers_.at(joint->child)];
            const std::size_t parent = joint->parent.empty() ? kNone : numbers_.at(joint->parent);
            if (child.rules.is_static)
                document_.lost(joint->where, Document::title_of(*element.element), "holds a static link, and is not carried over");
            else if (child.joint != kNone || hangs_on(parent, numbers_.at(joint->child)))
                close_loop(*joint);
            else
            {
                child.joint = joints_.size();
                if (parent != kNone) links_[parent].children.push_back(joints_.size());
                joints_.push_back(std::move(*joint));
            }
        }
    }

    bool hangs_on(std::size_t link, std::size_t ancestor) const
    {
        while (link != kNone && link != ancestor)
        {
            const std::size_t joint = links_[link].joint;
            link = joint == kNone || joints_[joint].parent.empty() ? kNone : numbers_.at(joints_[joint].parent);
        }
        return link == ancestor;
    }

    void close_loop(const SdfJoint& joint)
    {
        Coupling c;
        c.name = shown(joint.full), c.first = shown(joint.child), c.second = shown(joint.parent), c.where = joint.where;
        c.kind = joint.joints.empty() ? CouplingKind::Weld : CouplingKind::Loop;
        if (joint.joints.size() == 2)
        {
            document_.lost(joint.where, "<joint> '" + c.name + "'", "closes a loop as a ball joint: its third axis is free");
            c.kind = CouplingKind::Point;
        }
        if (!joint.joints.empty()) c.joint = joint.joints.front(), c.anchor = c.joint.anchor;
        if (!c.second.empty()) robot_.exclusions.push_back({c.first, c.second, c.where});
        robot_.couplings.push_back(std::move(c));
    }

    /// Parents before their children.
    void order()
    {
        std::map<std::string, std::size_t> rows;
        std::vector<std::size_t> waiting;
        for (std::size_t i = links_.size(); i-- > 0;)
            if (links_[i].joint == kNone || joints_[links_[i].joint].parent.empty()) waiting.push_back(i);
        while (!waiting.empty())
        {
            Link& link = links_[waiting.back()];
            waiting.pop_back();
            rows[link.full] = robot_.bodies.size();
            RobotBody body = std::move(link.body);
            if (link.joint != kNone)
            {
                const SdfJoint& joint = joints_[link.joint];
                body.free = false, body.joints = joint.joints;
                if (!joint.parent.empty())
                {
                    body.parent = rows.at(joint.parent);
                    body.pose = inverse(frames_.in_world(joint.parent)) * frames_.in_world(joint.child);
                    body.pose.q = normalized(body.pose.q);
                }
            }
            robot_.bodies.push_back(std::move(body));
            for (auto joint = link.children.rbegin(); joint != link.children.rend(); ++joint)
                waiting.push_back(numbers_.at(joints_[*joint].child));
        }
    }

    /// A joint that mimics another one begins where that one puts it, and follows it as a gear.
    void start_mimics()
    {
        std::map<std::string, Joint*> by_name;
        for (RobotBody& body : robot_.bodies)
            for (Joint& joint : body.joints) by_name[joint.name] = &joint;
        for (const SdfMimic& m : mimics_)
        {
            const std::string leader = shown(m.leader), name = shown(m.follower);
            const auto lead = by_name.find(leader), follower = by_name.find(name);
            if (lead == by_name.end() || follower == by_name.end() || leader == name)
            {
                document_.error(m.where, "<mimic>", "'" + name + "' cannot follow '" + leader + "': it has to be another moving joint");
                continue;
            }
            follower->second->start = m.multiplier * (lead->second->start - m.reference) + m.offset;
            robot_.couplings.push_back({CouplingKind::Gear, name + ".mimic", leader, name, m.multiplier, {}, {}, m.where});
        }
    }

    bool fixed_base_;
    Document& document_;
    SdfFiles files_;
    SdfFrames frames_;
    Robot robot_;
    std::vector<std::unique_ptr<XmlElement>> included_;
    std::vector<Link> links_;
    std::map<std::string, std::size_t> numbers_;  ///< of links, by full name
    std::vector<ReadJoint> joint_elements_;
    std::vector<SdfJoint> joints_;
    std::vector<SdfMimic> mimics_;
    std::size_t models_ = 0;
    std::string prefix_;
};

}  // namespace

Robot read_sdf(const XmlElement& root, const std::vector<std::string>& folders, bool fixed_base, Document& document)
{
    return SdfReader(folders, fixed_base, document).read(root);
}

}  // namespace plab::import
