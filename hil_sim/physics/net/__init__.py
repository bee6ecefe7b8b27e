"""A net of elastic hoops in space: its forces, its contacts, and the sparse solver of its motion."""
