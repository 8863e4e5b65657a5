"""Taylor steps for wavelets and for the rigid block."""
