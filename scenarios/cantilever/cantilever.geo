// The beam of this scene. Of size 0.01 and 0.007 (m), coarse.msh and fine.msh are made by
// gmsh -3 -order 2 -optimize_netgen -format msh41 -setnumber size 0.01 cantilever.geo -o coarse.msh
SetFactory("OpenCASCADE");
DefineConstant[ size = 0.01 ];
Box(1) = {0, -0.005, -0.005, 0.1, 0.01, 0.01};
MeshSize{:} = size;
Physical Volume("beam") = {1};
Physical Surface("clamp") = Surface In BoundingBox{-1e-4, -1, -1, 1e-4, 1, 1};
Physical Surface("end") = Surface In BoundingBox{0.0999, -1, -1, 0.1001, 1, 1};
