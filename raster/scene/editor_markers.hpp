#pragma once
// Nodes that a level's editor uses as markers and that its engine never draws: collision hulls, sectors, spawn points.

#include <string_view>

namespace earthshine::raster {

/// The engine by whose naming rule a node of this name is a marker; null if it is an ordinary node.
///   Castle Game Engine  CasMoveLimit, CasWater, CasSector*, CasWaypoint*, CasRes* (its manual, "Creating levels")
///   Unreal Engine       UBX_*, UCP_*, USP_*, UCX_* ("FBX Static Mesh Pipeline", collision)
///   Godot               *-colonly, *-convcolonly, *-navmesh, *-occonly ("Importing 3D scenes", name suffixes)
const char* markerEngine(std::string_view nodeName);

}  // namespace earthshine::raster
