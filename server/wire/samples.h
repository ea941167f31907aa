/// Records as samples of the wire.
///
/// A sample points into the record that it was made of, and into scratch of its own: it is good until the record goes
/// or the next one is made. Text and arrays of plain data are not copied.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "idl/identity.h"
#include "publish/records.h"

namespace plab::wire
{

/// Samples of a topic that a ring gave up.
struct Dropped
{
    const char* topic = "";
    std::uint64_t samples = 0;
};

class ServerSample
{
public:
    const plab_v1_Server& of(const Identity& identity, const publish::Status& status, std::span<const Dropped> dropped);

private:
    plab_v1_Server wire_{};
    std::vector<plab_v1_Dropped> dropped_;
    std::vector<plab_v1_KeptSnapshot> snapshots_;
};

class SceneSample
{
public:
    const plab_v1_Scene& of(const std::string& server, const publish::SceneEntry& scene);

private:
    plab_v1_Scene wire_{};
    std::vector<plab_v1_View> cameras_;
};

class ObjectSample
{
public:
    const plab_v1_Object& of(const publish::ObjectEntry& object);

private:
    plab_v1_Object wire_{};
    std::vector<char*> shapes_;
    std::vector<plab_v1_Parameter> parameters_;
};

class ShapeSample
{
public:
    const plab_v1_Shape& of(const publish::ShapeEntry& shape);

private:
    plab_v1_Shape wire_{};
};

class InteractionSample
{
public:
    const plab_v1_Interaction& of(const publish::InteractionEntry& interaction);

private:
    plab_v1_Interaction wire_{};
    std::vector<std::vector<char*>> members_;
    std::vector<plab_v1_Participants> roles_;
    std::vector<plab_v1_Parameter> parameters_;
};

class TypeSample
{
public:
    const plab_v1_Type& of(const model::TypeSummary& type);

private:
    plab_v1_Type wire_{};
    std::vector<plab_v1_RoleInfo> roles_;
    std::vector<plab_v1_FieldInfo> fields_;
};

class FrameSample
{
public:
    const plab_v1_Frame& of(const publish::Frame& frame);

private:
    plab_v1_Frame wire_{};
};

class CollisionsSample
{
public:
    const plab_v1_Collisions& of(const publish::Batch<publish::CollisionRecord>& batch);

private:
    plab_v1_Collisions wire_{};
    std::vector<plab_v1_CollisionInfo> entries_;
};

class EventsSample
{
public:
    const plab_v1_Events& of(const publish::Batch<publish::EventRecord>& batch);

private:
    plab_v1_Events wire_{};
    std::vector<plab_v1_EventInfo> entries_;
};

class MetricsSample
{
public:
    const plab_v1_Metrics& of(const publish::Metrics& metrics);

private:
    plab_v1_Metrics wire_{};
    std::vector<std::vector<plab_v1_Parameter>> outputs_;
    std::vector<plab_v1_InteractionMetrics> interactions_;
};

class ImageSample
{
public:
    const plab_v1_Image& of(const publish::Image& image);

private:
    plab_v1_Image wire_{};
};

class JournalSample
{
public:
    const plab_v1_Journal& of(const publish::JournalRecord& entry);

private:
    plab_v1_Journal wire_{};
    std::vector<std::vector<plab_v1_NamedText>> values_;
    std::vector<plab_v1_Operation> operations_;
};

class HashesSample
{
public:
    const plab_v1_Hashes& of(const publish::HashRecord& record);

private:
    plab_v1_Hashes wire_{};
};

class SnapshotSample
{
public:
    const plab_v1_Snapshot& of(const publish::SnapshotRecord& snapshot);

private:
    plab_v1_Snapshot wire_{};
};

class ReplySample
{
public:
    const plab_v1_Reply& of(const publish::Answer& answer, bool repeated);

private:
    plab_v1_Reply wire_{};
    std::vector<std::string> texts_;
    std::vector<char*> reasons_;
    std::vector<std::vector<plab_v1_FieldFate>> fields_;
    std::vector<plab_v1_SwapReport> swaps_;
};

}  // namespace plab::wire
