/// Converts records to samples of the wire.
/// A sample points into the record that it was made of, and into scratch of its own: it is valid until the record is destroyed
/// or the next sample is made. Text and arrays of plain data are not copied.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "idl/identity.h"
#include "publish/records.h"

namespace plab::wire
{

/// Samples of a topic that a ring dropped.
struct Dropped
{
    const char* topic = "";
    std::uint64_t samples = 0;
};

class ServerSample
{
public:
    const plab_v2_Server& of(const Identity& identity, const publish::Status& status, std::span<const Dropped> dropped);

private:
    plab_v2_Server wire_{};
    std::vector<plab_v2_DroppedSamples> dropped_;
    std::vector<plab_v2_KeptSnapshot> snapshots_;
};

class SceneSample
{
public:
    const plab_v2_Scene& of(const std::string& server, const publish::SceneEntry& scene);

private:
    plab_v2_Scene wire_{};
    std::vector<plab_v2_View> cameras_;
};

class ObjectSample
{
public:
    const plab_v2_SceneObject& of(const publish::ObjectEntry& object);

private:
    plab_v2_SceneObject wire_{};
    std::vector<char*> shapes_;
    std::vector<plab_v2_Parameter> parameters_;
};

class ShapeSample
{
public:
    const plab_v2_Shape& of(const publish::ShapeEntry& shape);

private:
    plab_v2_Shape wire_{};
};

class InteractionSample
{
public:
    const plab_v2_Interaction& of(const publish::InteractionEntry& interaction);

private:
    plab_v2_Interaction wire_{};
    std::vector<std::vector<char*>> members_;
    std::vector<plab_v2_Participants> roles_;
    std::vector<plab_v2_Parameter> parameters_;
};

class TypeSample
{
public:
    const plab_v2_Type& of(const model::TypeSummary& type);

private:
    plab_v2_Type wire_{};
    std::vector<plab_v2_RoleInfo> roles_;
    std::vector<plab_v2_FieldInfo> fields_;
};

class FrameSample
{
public:
    const plab_v2_Frame& of(const publish::Frame& frame);

private:
    plab_v2_Frame wire_{};
};

class CollisionsSample
{
public:
    const plab_v2_Collisions& of(const publish::Batch<publish::CollisionRecord>& batch);

private:
    plab_v2_Collisions wire_{};
    std::vector<plab_v2_CollisionInfo> entries_;
};

class EventsSample
{
public:
    const plab_v2_Events& of(const publish::Batch<publish::EventRecord>& batch);

private:
    plab_v2_Events wire_{};
    std::vector<plab_v2_EventInfo> entries_;
};

class MetricsSample
{
public:
    const plab_v2_Metrics& of(const publish::Metrics& metrics);

private:
    plab_v2_Metrics wire_{};
    std::vector<std::vector<plab_v2_Parameter>> outputs_;
    std::vector<plab_v2_InteractionMetrics> interactions_;
};

class ImageSample
{
public:
    const plab_v2_Image& of(const publish::Image& image);

private:
    plab_v2_Image wire_{};
};

class JournalSample
{
public:
    const plab_v2_Journal& of(const publish::JournalRecord& entry);

private:
    plab_v2_Journal wire_{};
    std::vector<std::vector<plab_v2_NamedText>> values_;
    std::vector<plab_v2_Operation> operations_;
};

class HashesSample
{
public:
    const plab_v2_Hashes& of(const publish::HashRecord& record);

private:
    plab_v2_Hashes wire_{};
};

class SnapshotSample
{
public:
    const plab_v2_Snapshot& of(const publish::SnapshotRecord& snapshot);

private:
    plab_v2_Snapshot wire_{};
};

class ReplySample
{
public:
    const plab_v2_Reply& of(const publish::Answer& answer, bool repeated);

private:
    plab_v2_Reply wire_{};
    std::vector<std::string> texts_;
    std::vector<char*> reasons_;
    std::vector<std::vector<plab_v2_FieldFate>> fields_;
    std::vector<plab_v2_SwapReport> swaps_;
    std::string trial_;
};

}  // namespace plab::wire
