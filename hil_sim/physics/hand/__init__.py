"""Two soft fingers and the object between them: tips, grasp, friction, motion, servos."""
