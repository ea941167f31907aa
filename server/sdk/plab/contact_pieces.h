/// What a system says of a step that the host has divided for contacts of springs.
#pragma once

namespace plab
{

/// Implemented by systems that may have such contacts; see DynamicSystem (dynamics.h).
class ContactPieces
{
public:
    virtual ~ContactPieces() = default;
    /// Contacts are the only forces that are not uniform; joints may hold members. The advance is then as short as the springs of the
    /// contacts need, whatever the method: where its slopes differ all the same, a contact begins, ends, slips, sticks or passes an edge,
    /// and an implicit method would only look for that in ever shorter steps.
    virtual bool are_only_contacts() const = 0;
};

}  // namespace plab
