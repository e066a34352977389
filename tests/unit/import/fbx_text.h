// SPDX-License-Identifier: MIT
// A small FBX file as text.
#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace boxtree::cooker {

// A ladder of eight vertices, placed twice. `corners`: polygons, each ended by -1 - its last
// vertex; `materials`: of each, by number among stone and glass.
inline std::string fbx_text(const std::string& corners, std::size_t corner_count,
                            const std::string& materials, std::size_t face_count) {
  return fmt::format(R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {{
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}}
GlobalSettings:  {{
	Version: 1000
}}
Objects:  {{
	Geometry: 10, "Geometry::ladder", "Mesh" {{
		Vertices: *24 {{
			a: 0,0,0,1,0,0,2,0,0,3,0,0,0,1,0,1,1,0,2,1,0,3,1,0
		}}
		PolygonVertexIndex: *{} {{
			a: {}
		}}
		GeometryVersion: 124
		LayerElementMaterial: 0 {{
			Version: 101
			Name: ""
			MappingInformationType: "ByPolygon"
			ReferenceInformationType: "IndexToDirect"
			Materials: *{} {{
				a: {}
			}}
		}}
		Layer: 0 {{
			Version: 100
			LayerElement:  {{
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}}
		}}
	}}
	Model: 20, "Model::left", "Mesh" {{
		Version: 232
	}}
	Model: 21, "Model::right", "Mesh" {{
		Version: 232
		Properties70:  {{
			P: "Lcl Translation", "Lcl Translation", "", "A",0,0,5
		}}
	}}
	Material: 30, "Material::stone", "" {{
		Version: 102
		ShadingModel: "phong"
	}}
	Material: 31, "Material::glass", "" {{
		Version: 102
		ShadingModel: "phong"
	}}
}}
Connections:  {{
	C: "OO",20,0
	C: "OO",21,0
	C: "OO",10,20
	C: "OO",10,21
	C: "OO",30,20
	C: "OO",31,20
	C: "OO",30,21
	C: "OO",31,21
}}
)",
                     corner_count, corners, face_count, materials);
}

}  // namespace boxtree::cooker
