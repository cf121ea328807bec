#include "raster/scene/editor_markers.hpp"

namespace earthshine::raster {

const char* markerEngine(std::string_view name) {
    for (const std::string_view whole : {"CasMoveLimit", "CasWater"})
        if (name == whole) return "Castle Game Engine";
    for (const std::string_view prefix : {"CasSector", "CasWaypoint", "CasRes"})
        if (name.starts_with(prefix)) return "Castle Game Engine";
    for (const std::string_view prefix : {"UBX_", "UCP_", "USP_", "UCX_"})
        if (name.starts_with(prefix)) return "Unreal Engine";
    for (const std::string_view suffix : {"-colonly", "-convcolonly", "-navmesh", "-occonly"})
        if (name.ends_with(suffix)) return "Godot";
    return nullptr;
}

}  // namespace earthshine::raster
