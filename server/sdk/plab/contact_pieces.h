/// What a system says of a step that the host has divided for contacts of springs.
#pragma once

namespace plab
{

/// Implemented by systems that may have such contacts; see DynamicSystem (dynamics.h).
class ContactPieces
{
public:
    virtual ~ContactPieces() = default;
    /// Contacts are the only forces that are not uniform, and no rows constrain the members. The advance is then as short as the springs
    /// of the contacts need, whatever the method: where its slopes differ all the same, a contact begins, ends, or passes an edge, and
    /// shorter steps would not help.
    virtual bool are_only_contacts() const = 0;
};

}  // namespace plab
