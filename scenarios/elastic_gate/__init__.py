"""A dam breaks through an elastic gate: scene, set-up of Antoci, Gallati and Sibilla."""
