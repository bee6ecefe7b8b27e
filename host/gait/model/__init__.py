"""What a plan comes to on a model of its robot's coils."""
