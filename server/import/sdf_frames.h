/// The frames of SDF 1.7 and later (sdformat.org, "Pose semantics"): models, links, joints and frames have names within scopes, each with
/// a pose relative to another one, and each is attached to a link.
///
/// A scope is the full name of a model, "" for the world; a full name is that of the scope, "::", and the name inside. Inside a scope,
/// "__model__" is the model's own frame and "world" that of the world.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "import/document.h"

namespace plab::import
{

struct SdfFrame
{
    std::string scope;        ///< in which its names are meant
    std::string relative_to;  ///< of its pose
    Pose pose;                ///< of itself, or of its placement frame
    std::string attached_to;  ///< "": itself, which is a link. Of a model its canonical link, a name inside it
    bool is_model = false;
    std::string placement;  ///< of a model: the frame inside it that `pose` places; "": its own
    TextPosition where;
    std::string element;  ///< for messages
};

class SdfFrames
{
public:
    explicit SdfFrames(Document& document) : document_(document) {}

    static std::string full_name(const std::string& scope, const std::string& name) { return scope.empty() ? name : scope + "::" + name; }

    /// False, with an error, if the name is taken.
    bool add(const std::string& full, SdfFrame frame);
    /// The full name that `name` means in `scope`; "" for the world. None, with an error at `where`, if there is no such frame.
    std::optional<std::string> find(const std::string& scope, const std::string& name, TextPosition where, const std::string& element);
    /// X_WF. Errors (unknown names, poses that depend on themselves) give the identity.
    Pose in_world(const std::string& full);
    /// The full name of the link that the frame is attached to; "" for the world. None with an error.
    std::optional<std::string> link_of(const std::string& full);

private:
    struct Entry
    {
        SdfFrame frame;
        Pose X_WF;
        enum
        {
            Open,
            Busy,
            Done
        } state = Open;
    };
    Pose in_model(const std::string& full, const std::string& model, int depth);
    /// X of `base` to the frame: its pose, and what its placement frame makes of it.
    Pose step_to(const SdfFrame& frame, const std::string& full, int depth);

    Document& document_;
    std::map<std::string, Entry, std::less<>> entries_;
};

}  // namespace plab::import
