"""Bodies from surface meshes: `mesh` has their properties, `repair` what is mended of a mesh."""
